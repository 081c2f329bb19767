"""The numbers that training starts from: the same for the encoder and the decoder.

Trained weights are near where they began, those of the first layer and of UVs above all: a file
needs to say only how far they went.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Int64Array, Uint64Array

BITS = 23
"""Initial weights are integers from -2^BITS to below 2^BITS, which stand for [-1, 1)."""

_GAMMA = np.uint64(0x9E3779B97F4A7C15)


def initial_integers(seed: int, first: int, count: int) -> Int64Array:
    """(count,) int64 initial weights of a network with this seed, from its weight `first` on.

    Integers from -2^BITS to below 2^BITS. SplitMix64 (Steele, Lea, Flood, "Fast splittable
    pseudorandom number generators", 2014).
    """
    start = _mixed(np.array([seed], np.uint64))
    places = np.arange(first + 1, first + count + 1, dtype=np.uint64)
    found = _mixed(start + places * _GAMMA) >> np.uint64(63 - BITS)
    return found.astype(np.int64) - (1 << BITS)


def predicted(initial: Int64Array, scale: int, row_shifts: Int64Array) -> Int64Array:
    """Symbols as initial weights predict them: `scale` times each in [-1, 1), over 2^row_shift.

    initial (...,) as `initial_integers` gives them; row_shifts (...,) or one for all -> (...,)
    int64, halves rounded up.
    """
    return (scale * initial + (1 << BITS - 1 + row_shifts)) >> BITS + row_shifts


def _mixed(state: Uint64Array) -> Uint64Array:
    state = (state ^ state >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ state >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return state ^ state >> np.uint64(31)
