"""Copies of mesh parts that meet: where their borders lie on each other, they are one surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import edge_ids, row_ids
from nispcodec.core.creases import sharp_sides

REACH = 1e-6
"""Share of the radius: what float32 leaves between borders that are one, far less than a step."""


def met(mesh: TexturedMesh, radius: float, silent: BoolArray) -> TexturedMesh:
    """The mesh with ends of borders that lie within `REACH` in one place, so that shading goes on.

    Over borders that turn sharply it breaks where nobody said which edges are creases.

    silent: (m,) bool, the faces of parts that say of no edge that it is a crease.
    """
    border = _borders(mesh)
    ends = np.unique(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2)[border])
    if not len(ends) or mesh.creases is None:
        return mesh
    positions = mesh.positions.astype(np.float64)
    positions[ends] = _in_one_place(positions[ends], REACH * radius)
    places = row_ids(positions)[mesh.faces]
    sharp = sharp_sides(places, positions[mesh.faces])
    return replace(
        mesh, positions=positions, creases=mesh.creases | (border & sharp & silent[:, None])
    )


def _borders(mesh: TexturedMesh) -> BoolArray:
    """(m, 3): the sides of edges of one face, vertices in one place told apart."""
    edges, _ = edge_ids(mesh.faces.astype(np.int64))
    return np.asarray((np.bincount(edges)[edges] == 1).reshape(-1, 3))


def _in_one_place(points: Float64Array, reach: float) -> Float64Array:
    """Points (n, 3), those that are near each other along every axis where the first of them is."""
    places = row_ids(np.stack([_clusters(each, reach) for each in points.T], axis=1))
    _, first = np.unique(places, return_index=True)
    return np.asarray(points[first[places]])


def _clusters(numbers: Float64Array, reach: float) -> Int64Array:
    """(n,): a number for each run of numbers that are within `reach` of the next."""
    order = np.argsort(numbers, kind="stable")
    found = np.zeros(len(numbers), np.int64)
    found[order[1:]] = np.cumsum(np.diff(numbers[order]) > reach)
    return found
