"""How often each token of a tensor occurs: a bell curve of a few parameters, in integers.

Trained weights are spread about zero, somewhere between Laplace's curve and the normal one, cut
off at the largest. Two bytes say that; a table of frequencies would take more than a tensor of a
few hundred weights could save.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Int64Array
from nispcodec.format.codings.rans import SCALE, SCALE_BITS
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import MAX_CELLS

_ONE_BITS = 24
_NARROWNESSES = np.arange(32)
_TAILS = range(4)
_HAS_ZEROS = 0x80


@dataclass(frozen=True)
class FrequencyModel:
    """Student's t distribution of 2^(tail + 1) - 1 degrees of freedom, in half-octave widths.

    narrowness  0 to 31
    tail        0 to 3: from heavy to nearly normal
    zeros       0, or the share of zeros in 256ths where the curve does not tell it
    """

    narrowness: int
    tail: int
    zeros: int

    def encode(self) -> bytes:
        """One byte; two when there is a share of zeros."""
        byte = self.narrowness | self.tail << 5
        return bytes([byte | _HAS_ZEROS, self.zeros]) if self.zeros else bytes([byte])

    def starts(self, cells: int) -> Int64Array:
        """(2 cells + 2,) int64: where the frequency of each token begins, and the end.

        Tokens run from -cells to cells; the end is `rans.SCALE`.
        """
        half = frequencies(cells, np.array([self.narrowness]), self.tail, self.zeros)[0]
        both = np.concatenate([half[:0:-1], half])
        return np.concatenate([[0], np.cumsum(both)])


def decode(reader: Reader) -> FrequencyModel:
    """The inverse of `FrequencyModel.encode`. Raises FormatError for a share of zeros that is 0."""
    byte = reader.take(1, "model")[0]
    zeros = reader.take(1, "zeros")[0] if byte & _HAS_ZEROS else 0
    if byte & _HAS_ZEROS and not zeros:
        raise reader.error("zeros", "1 to 255", 0)
    return FrequencyModel(byte & 31, byte >> 5 & 3, zeros)


def cells(limit: int) -> tuple[int, int]:
    """How many cells hold magnitudes from 1 to `limit`, and how many bits a cell leaves open."""
    open_bits = (max(limit - 1, 0) // MAX_CELLS).bit_length()
    return (limit + (1 << open_bits) - 1) >> open_bits, open_bits


def fit(counts: Int64Array) -> tuple[FrequencyModel, float]:
    """The frequency model that takes the fewest bits for a run, and how many.

    counts (cells + 1,): how often 0 and each cell, of either sign, occur.
    """
    total = int(counts.sum())
    share = min(max(round(256 * int(counts[0]) / total), 1), 255)
    used = np.flatnonzero(counts)
    best: tuple[float, FrequencyModel] | None = None
    for zeros in (0, share):
        for tail in _TAILS:
            tables = frequencies(len(counts) - 1, _NARROWNESSES, tail, zeros)[:, used]
            bits = SCALE_BITS * total - np.log2(tables) @ counts[used]
            narrowness = int(bits.argmin())
            cost = float(bits[narrowness]) + (8 if zeros else 0)
            if best is None or cost < best[0]:
                best = cost, FrequencyModel(narrowness, tail, zeros)
    assert best is not None
    return best[1], best[0]


def frequencies(cells: int, narrowness: Int64Array, tail: int, zeros: int) -> Int64Array:
    """Frequencies (n, cells + 1) of 0 and of each cell, for each narrowness (n,).

    A cell's is that of either sign: 0 and both signs of all cells add up to `rans.SCALE`.
    """
    ratio = ((2 + narrowness % 2) << narrowness // 2)[:, None]
    wide = 4 * cells * cells << tail
    height = (wide << _ONE_BITS) // (wide + ratio * np.arange(cells + 1) ** 2)
    for _ in range(tail):
        height = height * height >> _ONE_BITS
    height += 1
    if zeros:
        height[:, 0] = 0
    free = SCALE - 2 * cells - 1
    sum_of_both = 2 * height.sum(axis=1, keepdims=True) - height[:, :1]
    table = 1 + height * (free - (free * zeros >> 8)) // sum_of_both
    table[:, 0] = SCALE - 2 * table[:, 1:].sum(axis=1)
    return table
