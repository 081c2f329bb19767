"""Closest points on triangles, asked often of the same triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.geometry.nearest import NearestTriangles


@dataclass(frozen=True)
class Hits:
    """n points on faces: faces (n,) int64, barycentric weights (n, 3), positions (n, 3)."""

    faces: Int64Array
    weights: Float64Array
    positions: Float64Array

    def interpolate(self, corners: Float64Array) -> Float64Array:
        """(m, 3, d) values at the corners of the faces -> (n, d) at the points."""
        values: Float64Array = np.einsum("nk,nkd->nd", self.weights, corners[self.faces])
        return values


@dataclass(frozen=True)
class Tree:
    """Triangles by the positions (m, 3, 3) of their corners, which must not all be without area."""

    corners: Float64Array

    def closest(self, points: Float64Array) -> Hits:
        """The closest point of the triangles for each of (n, 3) points."""
        which, triangles = self._solid
        found = triangles.closest(points)
        return Hits(which[found.faces], found.weights, found.positions)

    def forget(self) -> None:
        """Free all but the triangles; it grows again for the next question."""
        for name in ("normals", "areas", "_crosses", "_solid", "_which"):
            vars(self).pop(name, None)

    @property
    def is_flat(self) -> bool:
        """Whether no triangle has an area: then there is no closest point."""
        return not len(self._which)

    @cached_property
    def normals(self) -> Float64Array:
        """(m, 3): unit normals of the faces; 0 for one without area."""
        return unit(self._crosses)

    @cached_property
    def areas(self) -> Float64Array:
        """(m,)"""
        areas: Float64Array = np.linalg.norm(self._crosses, axis=1) / 2
        return areas

    @cached_property
    def _crosses(self) -> Float64Array:
        a, b, c = np.moveaxis(self.corners, 1, 0)
        crosses: Float64Array = np.cross(b - a, c - a)
        return crosses

    @cached_property
    def _solid(self) -> tuple[Int64Array, NearestTriangles]:
        return self._which, NearestTriangles(self.corners[self._which])

    @cached_property
    def _which(self) -> Int64Array:
        # Faces without area have no normal that tells on which side of them one is.
        edges = self.corners - np.roll(self.corners, 1, axis=1)
        longest = np.square(edges).sum(axis=2).max(axis=1)
        return np.flatnonzero(2 * self.areas > FLAT * longest)


FLAT = 1e-7
"""A face whose height is less than this part of its longest edge is a line, to double precision."""


def unit(vectors: Float64Array) -> Float64Array:
    """(n, 3) -> (n, 3) of length 1; 0 stays 0."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.maximum(lengths, np.finfo(np.float64).tiny)
