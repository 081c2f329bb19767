"""A tree of boxes around triangles, the same for every search."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, IntArray
from nispcodec.infer.triangles import ROWS, triangle_rows

BRANCHES = 8
"""Children of a node and triangles of a leaf: as many as a processor compares at a time."""

BLOCK = 1 << 10
"""Leaves whose triangles are computed at a time."""


@dataclass(frozen=True)
class MeshTree:
    """Triangles in leaves of BRANCHES, and boxes around them, level by level from the root.

    boxes      one array (nodes, 6, BRANCHES) float64 a level: the least x, y, z of the node's
               children, then the greatest. Child k of node i is node BRANCHES * i + k of the next
               level, or that leaf. A child with nothing in it has its least at infinity
    triangles  (leaves, ROWS, BRANCHES) float64, see `nispcodec.infer.triangles`
    faces      (leaves, BRANCHES) int32: their numbers. A leaf that is not full has its first
               triangle again
    solid      (leaves, BRANCHES) bool: whether the place counts for what is inside
    """

    boxes: tuple[Float64Array, ...]
    triangles: Float64Array
    faces: Int32Array
    solid: BoolArray

    @staticmethod
    def of(corners: Float64Array, sheet: BoolArray) -> MeshTree:
        """The tree of triangles (f, 3, 3), at least one; those of sheets (f,) are not solid."""
        order = _leaves(corners)
        there = order >= 0
        faces = np.where(there, order, order[:, :1])
        return MeshTree(
            boxes=_levels(_leaf_boxes(corners[faces])),
            triangles=_rows(corners, faces),
            faces=faces.astype(np.int32),
            solid=there & ~sheet[faces],
        )


NOTHING = np.repeat([np.inf, -np.inf], 3)
"""The box around nothing."""


def _leaves(corners: Float64Array) -> IntArray:
    """(leaves, BRANCHES) numbers of triangles that are near each other; -1: nothing.

    The triangles are halved along the longest side of the box of their centers, again and again.
    """
    count = len(corners)
    depth = max(0, int(np.ceil(np.log2(count / BRANCHES))))
    # A row for each of x, y, z: numpy looks along rows several times as fast.
    centers = np.full((3, BRANCHES << depth), np.inf)
    centers[:, :count] = (corners.min(axis=1) + corners.max(axis=1)).T * 0.5
    groups: IntArray = np.arange(centers.shape[1])[None]
    for _ in range(depth):
        groups = _halved(groups, centers)
    # Centers that are none are the last of all.
    leaves = np.sort(groups, axis=1)[: -(-count // BRANCHES)]
    return np.where(leaves < count, leaves, -1)


def _halved(groups: IntArray, centers: Float64Array) -> IntArray:
    """Groups (g, size) of indices of centers (3, n), each halved along its longest side."""
    members = centers.take(groups, axis=1)
    high = members.max(axis=2)
    partly = np.flatnonzero(np.isinf(high[0]))
    some = members[:, partly]
    high[:, partly] = np.where(np.isfinite(some), some, -np.inf).max(axis=2)
    axis = (high - members.min(axis=2)).argmax(axis=0)
    along = members[axis, np.arange(len(groups))]
    half = groups.shape[1] // 2
    order = np.argpartition(along, half, axis=1)
    return np.take_along_axis(groups, order, axis=1).reshape(-1, half)


def _rows(corners: Float64Array, faces: IntArray) -> Float64Array:
    """(leaves, ROWS, BRANCHES) of the triangles `faces` (leaves, BRANCHES), some at a time."""
    rows = np.empty((len(faces), ROWS, BRANCHES))
    for start in range(0, len(faces), BLOCK):
        some = faces[start : start + BLOCK]
        found = triangle_rows(corners[some.ravel()]).reshape(ROWS, -1, BRANCHES)
        rows[start : start + BLOCK] = found.transpose(1, 0, 2)
    return rows


def _leaf_boxes(corners: Float64Array) -> Float64Array:
    """(leaves, 6): around triangles (leaves, BRANCHES, 3, 3)."""
    return np.concatenate([corners.min(axis=(1, 2)), corners.max(axis=(1, 2))], axis=1)


def _levels(boxes: Float64Array) -> tuple[Float64Array, ...]:
    """All levels, the root first, from the leaves' boxes (leaves, 6)."""
    levels: list[Float64Array] = []
    while not levels or len(boxes) > 1:
        missing = -len(boxes) % BRANCHES
        boxes = np.concatenate([boxes, np.tile(NOTHING, (missing, 1))])
        nodes = boxes.reshape(-1, BRANCHES, 6)
        levels.insert(0, np.ascontiguousarray(nodes.transpose(0, 2, 1)))
        boxes = np.concatenate([nodes[:, :, :3].min(axis=1), nodes[:, :, 3:].max(axis=1)], axis=1)
    return tuple(levels)
