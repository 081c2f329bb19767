"""The curves that must stay where they are: borders and seams."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.simplify.triangles import Triangles, side_numbers


def own_corners(triangles: Triangles) -> Int64Array:
    """(m, 3): a number for each corner on its patch; equal where UVs, or places without UV, are."""
    count = len(triangles.positions)
    places = triangles.patches[:, None].astype(np.int64) * count + triangles.faces
    return np.where(triangles.uv_faces >= 0, triangles.uv_faces, len(triangles.uvs) + places)


def border_sides(triangles: Triangles) -> BoolArray:
    """(m, 3) bool: whether the side from each corner to the next is of one face only."""
    edges = side_numbers(triangles.faces)
    return np.asarray(np.bincount(edges.ravel())[edges] == 1)


def seam_sides(triangles: Triangles) -> BoolArray:
    """(m, 3) bool: whether the faces at a side do not share both UVs, or are of two patches."""
    edges, own = side_numbers(triangles.faces), side_numbers(own_corners(triangles))
    return np.asarray(np.bincount(own.ravel())[own] < np.bincount(edges.ravel())[edges])


def ends_of(triangles: Triangles, sides: BoolArray) -> Int64Array:
    """(k, 2): the ends of the edges of the given sides (m, 3) bool, each edge once."""
    ends = np.stack([triangles.faces, np.roll(triangles.faces, -1, axis=1)], axis=2)[sides]
    edges: Int64Array = np.unique(np.sort(ends, axis=1), axis=0)
    return edges


@dataclass(frozen=True)
class Segments:
    """Straight pieces from starts (k, 3) to ends (k, 3)."""

    starts: Float64Array
    ends: Float64Array

    @cached_property
    def length(self) -> float:
        """The length of all pieces."""
        return float(self._lengths.sum())

    def spread(self, count: int, rng: np.random.Generator) -> Float64Array:
        """(count, 3): points, evenly by length."""
        cumulative = np.cumsum(self._lengths)
        drawn = (np.arange(count) + rng.random(count)) / count * cumulative[-1]
        which = np.minimum(np.searchsorted(cumulative, drawn), len(cumulative) - 1)
        along = rng.random((count, 1))
        points: Float64Array = self.starts[which] * (1 - along) + self.ends[which] * along
        return points

    def closest(self, points: Float64Array) -> tuple[Int64Array, Float64Array, Float64Array]:
        """For (n, 3) points the closest: pieces (n,), shares (n, 2) of both ends, places (n, 3)."""
        vertices, pairs, tree = self._tree
        _, which, places = tree.squared_distance(vertices, pairs, points)
        start, way = self.starts[which], self.ends[which] - self.starts[which]
        square = np.maximum(np.square(way).sum(axis=1), np.finfo(np.float64).tiny)
        along = np.clip(((places - start) * way).sum(axis=1) / square, 0, 1)
        return which, np.stack([1 - along, along], axis=1), places

    @cached_property
    def _lengths(self) -> Float64Array:
        lengths: Float64Array = np.linalg.norm(self.ends - self.starts, axis=1)
        return lengths

    @cached_property
    def _tree(self) -> tuple[Float64Array, Int64Array, Any]:
        import igl

        vertices = np.concatenate([self.starts, self.ends])
        count = len(self.starts)
        pairs = np.stack([np.arange(count), np.arange(count) + count], axis=1)
        tree = igl.AABB()
        tree.init(vertices, pairs)
        return vertices, pairs, tree
