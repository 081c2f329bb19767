"""Pieces of a decoded surface where the original has none."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array, IntArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import connected_components
from nispcodec.metrics.surface import Surface, frame_of

FAR = 0.02


def spurious_components(decoded: TexturedMesh, original: TexturedMesh) -> dict[str, float]:
    """Count and area of the decoded components that lie wholly further than FAR from the original.

    Normalized frame of the original. A component is a set of faces connected through shared
    positions; it is far when all its vertices are.
    """
    frame = frame_of(original)
    surface, known = Surface.of(decoded, frame), Surface.of(original, frame)
    labels = components(decoded)
    _, first = np.unique(labels, return_index=True)
    # One vertex near the original clears a component: only of those left are all vertices asked.
    suspects = _distances(known, surface, decoded.faces[first, 0]) > FAR
    asked = np.flatnonzero(suspects[labels])
    nearest = np.where(suspects, np.inf, 0.0)
    corners = _distances(known, surface, decoded.faces[asked].ravel()).reshape(-1, 3)
    np.minimum.at(nearest, labels[asked], corners.min(axis=1))
    far = nearest > FAR
    return {"count": int(far.sum()), "area": float(surface.areas[far[labels]].sum())}


def _distances(known: Surface, surface: Surface, vertices: IntArray) -> Float64Array:
    positions = surface.positions[vertices]
    if len(positions) == 0:
        return np.zeros(0)
    distances: Float64Array = np.linalg.norm(known.closest(positions).positions - positions, axis=1)
    return distances


def components(mesh: TexturedMesh) -> Int64Array:
    """(m,): the component of each face; vertices at equal positions count as one."""
    _, welded = np.unique(mesh.positions, axis=0, return_inverse=True)
    faces = welded.reshape(-1)[mesh.faces]
    _, labels = connected_components(faces[:, :2], faces[:, 1:], len(mesh.positions))
    _, compact = np.unique(labels[faces[:, 0]], return_inverse=True)
    return np.asarray(compact, dtype=np.int64)
