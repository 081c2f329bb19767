"""The numbers that networks start from: the same for who writes a file and for who reads it.

Trained weights are near where they began, those of the first layer and of UVs above all: what a
file has to say of them is how far they went.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Integers = NDArray[np.int64]

BITS = 23
"""Draws are integers from -2^BITS to below 2^BITS."""

_GAMMA = np.uint64(0x9E3779B97F4A7C15)


def draws(number: int, first: int, count: int) -> Integers:
    """(count,) the draws of this number from the place `first` on.

    SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
    """
    start = _mixed(np.array([number], np.uint64))
    places = np.arange(first + 1, first + count + 1, dtype=np.uint64)
    found = _mixed(start + places * _GAMMA) >> np.uint64(63 - BITS)
    return found.astype(np.int64) - (1 << BITS)


def told(drawn: Integers, reach: int, octaves: Integers) -> Integers:
    """What draws let expect of symbols: `reach` times the draw in [-1, 1), in steps of 2^octave."""
    return (reach * drawn + (1 << BITS - 1 + octaves)) >> BITS + octaves


def _mixed(state: NDArray[np.uint64]) -> NDArray[np.uint64]:
    state = (state ^ state >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    state = (state ^ state >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return state ^ state >> np.uint64(31)
