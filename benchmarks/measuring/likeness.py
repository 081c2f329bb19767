"""How alike pictures of the same views are, in the paper's three numbers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.metrics.pictures import compare_pictures


def likeness(original: Float32Array, other: Float32Array) -> dict[str, float]:
    """PSNR (dB), SSIM and MSE of 8-bit values of two pictures (h, w, 3) in [0, 1]."""
    squares = (original.astype(np.float64) - other) ** 2
    return {**compare_pictures(original, other), "mse": 255**2 * float(squares.mean())}


def mean_likeness(
    originals: Iterable[Float32Array], others: Iterable[Float32Array]
) -> dict[str, float]:
    """The means of `likeness` over pairs of pictures."""
    found = [likeness(*pair) for pair in zip(originals, others, strict=True)]
    return {name: float(np.mean([each[name] for each in found])) for name in found[0]}
