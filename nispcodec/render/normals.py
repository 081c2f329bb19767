"""Smooth normals of a mesh that keep its hard edges hard."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import fan_normals
from nispcodec.metrics.surface import Surface

# Faces that lean further than this (degrees) away from each other meet in a hard edge.
CREASE = 45.0


def corner_normals(surface: Surface) -> Float64Array:
    """(m, 3, 3): a normal, not of unit length, for each corner of each face, normalized frame.

    The sum, weighted by area, of the normals of those faces at the corner's position that lean
    away from the corner's own face by less than CREASE. Positions that coincide are one. Where a
    mesh has creases, normals break over these instead.
    """
    if surface.mesh.creases is not None:
        places = row_ids(surface.positions)[surface.mesh.faces]
        rows, fans = fan_normals(places, surface.corners, surface.mesh.creases)
        return rows[fans]
    _, welded = np.unique(surface.positions, axis=0, return_inverse=True)
    vertices = welded.reshape(-1)[surface.mesh.faces].ravel()
    order = np.argsort(vertices, kind="stable")
    _, first, counts = np.unique(vertices[order], return_index=True, return_counts=True)
    valence, start = np.repeat(counts, counts), np.repeat(first, counts)
    faces, rank = order // 3, np.arange(len(order)) - start
    weighted = surface.normals * surface.areas[:, None]
    sums = weighted[faces]
    for turn in range(1, int(counts.max())):
        chosen = np.flatnonzero(valence > turn)
        mine = faces[chosen]
        other = faces[start[chosen] + (rank[chosen] + turn) % valence[chosen]]
        lean = (surface.normals[mine] * surface.normals[other]).sum(axis=1)
        sums[chosen] += weighted[other] * (lean > np.cos(np.radians(CREASE)))[:, None]
    normals = np.empty_like(sums)
    normals[order] = sums
    return normals.reshape(-1, 3, 3)
