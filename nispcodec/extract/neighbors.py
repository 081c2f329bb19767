"""Which groups of points have other points near them, by a grid of cells."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, Int64Array, IntArray

# Pairs of points that are measured at a time: it bounds memory.
PAIRS = 1 << 20
# The columns of cells at a cell and around it, its own first: most neighbors are found there.
COLUMNS = np.array([(0, 0), *((x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y)])


@dataclass(frozen=True)
class GroupedPoints:
    """Points (n, 3), and the group of each (n,)."""

    points: FloatArray
    groups: IntArray

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, chosen: BoolArray | IntArray) -> GroupedPoints:
        return GroupedPoints(self.points[chosen], self.groups[chosen])


def groups_with_neighbors(
    asked: GroupedPoints, others: GroupedPoints, reach: float, count: int
) -> BoolArray:
    """Which of `count` groups (count,) have a point `asked` with one of another group in `reach`.

    Groups are numbered from 0 up; `others` may have any numbers. Points of a group that is found to
    have neighbors are asked no further.
    """
    found = np.zeros(count, np.bool_)
    if not len(asked) or not len(others):
        return found
    corner = np.minimum(asked.points.min(axis=0), others.points.min(axis=0))
    shape = _cells(np.maximum(asked.points.max(axis=0), others.points.max(axis=0)), corner, reach)
    strides = np.array([(shape[1] + 2) * (shape[2] + 2), shape[2] + 2, 1])
    keys = _cells(others.points, corner, reach) @ strides
    order = np.argsort(keys)
    keys, others = keys[order], others[order]
    for column in COLUMNS:
        asked = asked[~found[asked.groups]]
        middle = _cells(asked.points, corner, reach) @ strides + column @ strides[:2]
        # Cells of a column follow each other.
        first = np.searchsorted(keys, middle - 1, side="left")
        last = np.searchsorted(keys, middle + 1, side="right")
        for one, other in _pairs(first, last):
            found[_near(asked[one], others[other], reach)] = True
    return found


def _cells(points: FloatArray, corner: FloatArray, size: float) -> Int64Array:
    """The cell (..., 3) of each point; from 1 up, so that every cell has one before it."""
    cells: Int64Array = ((points.astype(np.float64) - corner) // size).astype(np.int64) + 1
    return cells


def _near(one: GroupedPoints, other: GroupedPoints, reach: float) -> IntArray:
    """The groups of `one` whose point is near the other's, which is of another group."""
    offsets: Float64Array = one.points.astype(np.float64) - other.points
    near = np.einsum("ij,ij->i", offsets, offsets) <= reach * reach
    return one.groups[near & (one.groups != other.groups)]


def _pairs(first: Int64Array, last: Int64Array) -> Iterator[tuple[Int64Array, Int64Array]]:
    """Rows of `first` (n,), each with all numbers from `first` to below `last`; many at a time."""
    counts = last - first
    bins = np.cumsum(counts) // PAIRS
    for rows in np.split(np.arange(len(counts)), np.flatnonzero(np.diff(bins)) + 1):
        many = counts[rows]
        one = np.repeat(rows, many)
        within = np.arange(len(one)) - np.repeat(np.cumsum(many) - many, many)
        yield one, first[one] + within
