"""Points in an order that follows space: queries to a tree one after another stay in the cache.

Z-order curve (Morton 1966). In random order distances take twice as long, winding numbers up to 1.4
times (docs/decisions/0085-sampling-in-space-order.md).
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array

BITS = 7


def z_order(points: Float64Array) -> Int64Array:
    """Indices (n,) int64 that sort points (n, 3) along the Z-order curve.

    The curve runs through 2^BITS cells a side of their bounding cube.
    """
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    low = points.min(axis=0)
    size = float((points.max(axis=0) - low).max()) or 1.0
    cells = np.minimum((points - low) / size * (1 << BITS), (1 << BITS) - 1).astype(np.int64)
    code = np.zeros(len(points), dtype=np.int64)
    for bit in range(BITS):
        for axis in range(3):
            code |= (cells[:, axis] >> bit & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")
