"""Which points may have another chart beside them: told by cells, before any neighbor is sought."""

from __future__ import annotations

from itertools import product

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array

BITS = 20
"""Of a coordinate of a cell; one bit more keeps steps to the next cell from carrying over."""


def near_other_charts(points: Float32Array, charts: Int32Array, width: float) -> BoolArray:
    """Points (n,) that may have a point of another chart no further away than `width`.

    points (n, 3), charts (n,). True for all that have one so near, and for others nearly so near:
    those with another chart in their cell of this width or one of the 26 around it. Cells are
    wider where there would be more than 2^`BITS` in a row.
    """
    cells, place = np.unique(_cell_numbers(points, width), return_inverse=True)
    order = np.argsort(place, kind="stable")
    starts = np.searchsorted(place[order], np.arange(len(cells)))
    least, most = (kind.reduceat(charts[order], starts) for kind in (np.minimum, np.maximum))
    lowest, highest = least.copy(), most.copy()
    for step in product((-1, 0, 1), repeat=3):
        beside, found = _found(cells, cells + _packed(np.array(step)))
        lowest[found] = np.minimum(lowest[found], least[beside])
        highest[found] = np.maximum(highest[found], most[beside])
    mixed: BoolArray = (lowest != highest)[place]
    return mixed


def _cell_numbers(points: Float32Array, width: float) -> Int64Array:
    """A number (n,) for the cell of each point."""
    low = points.min(axis=0).astype(np.float64)
    size = float((points - low).max())
    width = max(width, size / ((1 << BITS) - 2)) or 1.0
    # From 1 on, so that no cell beside one has a number below 0.
    return _packed(((points - low) / width).astype(np.int64) + 1)


def _packed(cells: Int64Array) -> Int64Array:
    """Cells (..., 3) as one number each."""
    packed: Int64Array = (
        (cells[..., 0] << 2 * (BITS + 1)) + (cells[..., 1] << BITS + 1) + cells[..., 2]
    )
    return packed


def _found(known: Int64Array, sought: Int64Array) -> tuple[Int64Array, Int64Array]:
    """Which of `sought` are in `known`, which is sorted: their places there, and here."""
    place = np.searchsorted(known, sought).clip(max=len(known) - 1)
    found = np.flatnonzero(known[place] == sought)
    return place[found], found
