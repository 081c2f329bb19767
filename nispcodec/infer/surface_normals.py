"""Normals of a mesh at points on it: of faces, and of what several faces share."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array, IntArray

NONE = 1e-9
"""A corner with less weight than this has none: the point is on the edge across from it."""
TINY = 1e-10
"""What rounding leaves of area, in squares of the longest side, and of opposite normals."""


class SurfaceNormals:
    """Normals of triangles (f, 3, 3), one surface where their corners are in the same place.

    faces  (f, 3): unit, as the corners turn; 0 for a triangle without area
    """

    def __init__(self, corners: Float64Array) -> None:
        self._corners = corners
        self._sides = np.roll(corners, -1, axis=1) - corners
        areas = np.cross(self._sides[:, 0], self._sides[:, 1])
        longest = (self._sides**2).sum(axis=2).max(axis=1, initial=0)
        self.faces = _units(areas, TINY * longest)

    def at(self, faces: Int32Array, weights: Float64Array) -> Float64Array:
        """(n, 3) at points on faces (n,), by the weights of their corners (n, 3).

        On an edge the mean of its faces' normals, at a corner the mean by angle (Thürmer and
        Wüthrich 1998); where these are 0, as between two faces back to back, the face's own.
        """
        normals = self.faces[faces]
        absent = weights < NONE
        on_edge, at_corner = (np.flatnonzero(absent.sum(axis=1) == many) for many in (1, 2))
        if len(on_edge):
            edge = (absent[on_edge].argmax(axis=1) + 1) % 3
            normals[on_edge] = _or(self._edges[faces[on_edge], edge], normals[on_edge])
        if len(at_corner):
            corner = absent[at_corner].argmin(axis=1)
            normals[at_corner] = _or(self._points[faces[at_corner], corner], normals[at_corner])
        return normals

    @cached_property
    def _places(self) -> IntArray:
        """(f, 3): equal for corners in the same place."""
        _, places = np.unique(self._corners.reshape(-1, 3), axis=0, return_inverse=True)
        return places.reshape(-1, 3)

    @cached_property
    def _edges(self) -> Float64Array:
        """(f, 3, 3): the normal of the edge from corner i to i + 1 of each face."""
        ends = np.sort(np.stack([self._places, np.roll(self._places, -1, axis=1)], axis=2), axis=2)
        _, edges = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
        return _shared(edges.ravel(), np.repeat(self.faces, 3, axis=0))

    @cached_property
    def _points(self) -> Float64Array:
        """(f, 3, 3): the normal at each corner of each face."""
        sides = _units(self._sides, np.zeros(self._sides.shape[:2]))
        cosines = -(sides * np.roll(sides, 1, axis=1)).sum(axis=2)
        angles = np.arccos(np.clip(cosines, -1, 1))
        weighted = angles[:, :, None] * self.faces[:, None]
        return _shared(self._places.ravel(), weighted.reshape(-1, 3))


def _shared(owners: IntArray, vectors: Float64Array) -> Float64Array:
    """(f, 3, 3): the direction of the sum of all vectors (3 f, 3) of each one's owner (3 f,)."""
    each = [np.bincount(owners, vectors[:, axis]) for axis in range(3)]
    sums: Float64Array = np.stack(each, axis=1).astype(np.float64)
    units = _units(sums, np.full(len(sums), TINY))
    return units[owners].reshape(-1, 3, 3)


def _or(normals: Float64Array, others: Float64Array) -> Float64Array:
    """The normals (n, 3), the others where they are 0."""
    return np.where(normals.any(axis=1, keepdims=True), normals, others)


def _units(vectors: Float64Array, least: Float64Array) -> Float64Array:
    """Vectors (..., 3) with length 1; 0 where they are not longer than `least` (...)."""
    lengths = np.linalg.norm(vectors, axis=-1)
    factors = np.divide(1, lengths, out=np.zeros_like(lengths), where=lengths > least)
    return vectors * factors[..., None]
