"""Half-edges of some faces: which runs back along each, and which leave each vertex.

Half-edge h starts at corner h of the faces, read row by row, and ends at its face's next corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array, Int64Array


@dataclass(frozen=True)
class Wedges:
    """Some faces of an oriented manifold, and how they hang together.

    faces   (m, 3) int64
    starts  (3m,) the vertex that each half-edge starts at
    ends    (3m,) the vertex that it ends at
    twins   (3m,) the half-edge that runs back; -1: none of these faces has it
    border  (3m,) whether the faces at its sides are of two charts
    keys    (3m,) starts << 32 | ends, sorted
    leaving (3m,) half-edges sorted by their starts
    """

    faces: Int64Array
    starts: Int64Array
    ends: Int64Array
    twins: Int64Array
    border: BoolArray
    keys: Int64Array
    leaving: Int64Array

    @staticmethod
    def of(faces: Int64Array, charts: Int32Array) -> Wedges:
        """The half-edges of faces (m, 3) of the charts (m,)."""
        starts, ends = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
        keys = starts << 32 | ends
        order = np.argsort(keys)
        keys = keys[order]
        place = np.minimum(np.searchsorted(keys, ends << 32 | starts), len(keys) - 1)
        found = keys[place] == (ends << 32 | starts) if len(keys) else np.zeros(0, np.bool_)
        twins = np.where(found, order[place], -1)
        owner = np.repeat(charts, 3)
        # Sorted by start and end, they are sorted by start.
        return Wedges(faces, starts, ends, twins, owner != owner[twins], keys, order)

    def around(self, vertices: Int64Array) -> tuple[Int64Array, Int64Array]:
        """The half-edges that leave each of k vertices: numbers 0 to k - 1, half-edges."""
        first = np.searchsorted(self.keys, vertices << 32)
        counts = np.searchsorted(self.keys, (vertices + 1) << 32) - first
        owners = np.repeat(np.arange(len(vertices)), counts)
        within = np.arange(len(owners)) - np.repeat(np.cumsum(counts) - counts, counts)
        return owners, self.leaving[np.repeat(first, counts) + within]

    def linked(self, one: Int64Array, other: Int64Array) -> BoolArray:
        """Whether an edge joins each two vertices (k,), of which one has all its faces here."""
        return self._has(one, other) | self._has(other, one)

    def _has(self, start: Int64Array, end: Int64Array) -> BoolArray:
        keys = start << 32 | end
        place = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return self.keys[place] == keys
