"""Magnitudes as tokens of a small alphabet with extra bits.

A magnitude below 4 is its own token. Above, the token names its octave and the bit after the
leading one, and the bits below are stored as they are: within half an octave the distribution of
weights is flat enough to cost 1 to 2 percent.

    magnitude   0 1 2 3 4-5 6-7 8-11 12-15 16-23 24-31 32-47 ...
    token       0 1 2 3  4   5   6    7     8     9     10   ...
    extra bits  0 0 0 0  1   1   2    2     3     3     4    ...
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Magnitudes = NDArray[np.uint32]
Tokens = NDArray[np.uint8]


def from_magnitudes(magnitudes: Magnitudes) -> Tokens:
    """(n,) magnitudes below 2^31 -> (n,) tokens."""
    octave = np.frexp(magnitudes.astype(np.float64))[1].astype(np.int64) - 1
    half = magnitudes.astype(np.int64) >> np.maximum(octave - 1, 0) & 1
    return np.where(magnitudes < 4, magnitudes, 2 * octave + half).astype(np.uint8)


def extra_bits(tokens: Tokens) -> NDArray[np.uint8]:
    """(n,) how many bits of each magnitude its token leaves open."""
    return np.where(tokens < 4, 0, tokens // 2 - 1).astype(np.uint8)


def smallest(tokens: Tokens) -> Magnitudes:
    """(n,) the smallest magnitude of each token."""
    wide = tokens.astype(np.uint32)
    return np.where(wide < 4, wide, (2 + wide % 2) << extra_bits(tokens)).astype(np.uint32)
