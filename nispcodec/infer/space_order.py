"""Points in an order in which neighbors follow each other: what one needs, the next has at hand."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import FloatArray, IndexArray

BITS = 5
"""Of each coordinate, so that a place takes 15 bits: numpy sorts 16 bits without comparing."""
_SPREAD = np.array(
    [sum((cell >> bit & 1) << 3 * bit for bit in range(BITS)) for cell in range(1 << BITS)],
    np.uint16,
)


def space_order(points: FloatArray) -> IndexArray:
    """(n,) a permutation of points (n, 3): along a Z-order curve (Morton 1966) of 32^3 cells."""
    if not len(points):
        return np.zeros(0, np.intp)
    low = points.min(axis=0)
    longest = float((points.max(axis=0) - low).max()) or 1.0
    cells = ((points - low) / longest * (2**BITS - 0.01)).astype(np.uint8)
    x, y, z = _SPREAD[cells.T]
    return np.argsort(x | y << np.uint16(1) | z << np.uint16(2), kind="stable")
