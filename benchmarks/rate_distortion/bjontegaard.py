"""Bjontegaard-delta rate: how many bytes more or less one curve needs for the same error.

Bjontegaard, VCEG-M33 (2001), with monotone cubics (as in VCEG-AL22) in place of one cubic: the
curves here span decades. Quality is -20 log10(error), so that errors of any unit will do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nispcodec.core.arrays import Float64Array

Pair = tuple[float, float]

LEAST_POINTS, LEAST_WORTH = 5, 3
"""Measured, and of these on the front: through two points anything goes."""


def delta_rate(anchor: Sequence[Pair], tested: Sequence[Pair]) -> float | None:
    """Mean share of bytes that `tested` needs beyond `anchor`, -0.5 for half, at equal error.

    Curves are (bytes, error) pairs in any order; points that are not worth their bytes count for
    nothing. None when a curve has fewer than LEAST_POINTS points, or LEAST_WORTH that are worth
    their bytes, or when they share no range of errors.
    """
    curves = [front(anchor), front(tested)]
    if min(len(anchor), len(tested)) < LEAST_POINTS or min(map(len, curves)) < LEAST_WORTH:
        return None
    qualities = [-20 * np.log10(curve[:, 1]) for curve in curves]
    low, high = max(q[0] for q in qualities), min(q[-1] for q in qualities)
    if low >= high:
        return None
    from scipy.interpolate import PchipInterpolator

    rates = [
        PchipInterpolator(quality, np.log(curve[:, 0])).integrate(low, high) / (high - low)
        for quality, curve in zip(qualities, curves, strict=True)
    ]
    return float(np.exp(rates[1] - rates[0]) - 1)


def front(pairs: Sequence[Pair]) -> Float64Array:
    """The pairs (k, 2) of which no other has fewer bytes and no larger error, cheapest first."""
    best: list[Pair] = []
    for size, error in sorted(pairs):
        if not best or error < best[-1][1]:
            best.append((size, error))
    return np.array(best).reshape(-1, 2)
