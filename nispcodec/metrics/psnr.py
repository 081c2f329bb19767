"""Peak signal-to-noise ratio, with a ceiling so that equal things have a number too."""

from __future__ import annotations

import math

CEILING = 200.0


def psnr(mean_squared_error: float, peak: float) -> float:
    """Peak signal-to-noise ratio 10 log10(peak^2 / mean squared error) in dB, at most CEILING."""
    if mean_squared_error <= peak**2 * 10 ** (-CEILING / 10):
        return CEILING
    return 10 * math.log10(peak**2 / mean_squared_error)
