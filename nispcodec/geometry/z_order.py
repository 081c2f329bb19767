"""Points in an order that follows space: queries to a tree one after another stay in the cache.

Z-order curve (Morton 1966). In random order distances take twice as long, winding numbers up to 1.4
times (docs/decisions/0085-sampling-in-space-order.md).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array

BITS = 7
# How bits are moved apart to every third place, by halves (Anderson, "Bit Twiddling Hacks").
APART = ((8, 0x0300F00F), (4, 0x030C30C3), (2, 0x09249249))


def z_order(points: Float64Array) -> Int64Array:
    """Indices (n,) int64 that sort points (n, 3) along the Z-order curve.

    The curve runs through 2^BITS cells a side of their bounding cube.
    """
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    low = points.min(axis=0)
    size = float((points.max(axis=0) - low).max()) or 1.0
    cells = ((points - low) * ((1 << BITS) / size)).astype(np.int64).clip(max=(1 << BITS) - 1)
    for shift, mask in APART:
        cells = (cells | cells << shift) & mask
    code = cells[:, 0] | cells[:, 1] << 1 | cells[:, 2] << 2
    # Code and index in one number: sorting numbers is several times as fast as sorting indices.
    places = code << 32 | np.arange(len(points))
    places.sort()
    return places & 0xFFFFFFFF


def in_space_order(
    ask: Callable[[Float64Array], Float64Array], points: Float64Array
) -> Float64Array:
    """The answers (n,) of `ask` to points (n, 3), asked along the Z-order curve."""
    order = z_order(points)
    found = np.empty(len(points))
    found[order] = ask(points[order])
    return found
