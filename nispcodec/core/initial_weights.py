"""The numbers that networks start from: the same for who writes a file and for who reads it.

Trained weights are near where they began, those of the first layer and of UVs above all: what a
file has to say of them is how far they went.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Int64Array, Uint64Array

BITS = 23
"""Draws are integers from -2^BITS to below 2^BITS."""

_GAMMA = np.uint64(0x9E3779B97F4A7C15)


def draws(number: int, first: int, count: int) -> Int64Array:
    """(count,) the draws of this number from the place `first` on.

    SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
    """
    start = _mixed(np.array([number], np.uint64))
    places = np.arange(first + 1, first + count + 1, dtype=np.uint64)
    found = _mixed(start + places * _GAMMA) >> np.uint64(63 - BITS)
    return found.astype(np.int64) - (1 << BITS)


def told(drawn: Int64Array, reach: int, octaves: Int64Array) -> Int64Array:
    """What draws let expect of symbols: `reach` times the draw in [-1, 1), in steps of 2^octave."""
    return (reach * drawn + (1 << BITS - 1 + octaves)) >> BITS + octaves


def _mixed(state: Uint64Array) -> Uint64Array:
    state = (state ^ state >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ state >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return state ^ state >> np.uint64(31)
