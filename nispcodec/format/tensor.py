"""A tensor to write: what of its weights the file need not say again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import AnyArray, Int64Array
from nispcodec.core.initial_weights import BITS, told
from nispcodec.core.network import MAX_OCTAVE
from nispcodec.format.constants import MAX_SYMBOL


@dataclass(frozen=True)
class Tensor:
    """Its step, if it is quantised; its weights or symbols; the draws it began from.

    matrix  (rows, columns) float32 weights, or int32 symbols
    drawn   (rows, columns) those of `nispcodec.core.initial_weights`
    """

    path: str
    step: float | None
    matrix: AnyArray
    drawn: Int64Array

    @cached_property
    def reach(self) -> int:
        """That with which draws tell most of the symbols; 0 where they tell nothing."""
        if self.step is None:
            return 0
        shares = self.drawn / (1 << BITS)
        fitted = float((self.matrix * shares).sum() / (shares * shares).sum())
        reach = min(max(round(fitted), 0), MAX_SYMBOL)
        far = np.abs(self.matrix - told(self.drawn, reach, np.zeros(1, np.int64))).max()
        return reach if far <= MAX_SYMBOL else 0

    @cached_property
    def octaves(self) -> Int64Array:
        """(rows,) the largest powers of two that all symbols of a row are multiples of."""
        if self.step is None:
            return np.zeros(len(self.matrix), np.int64)
        every = np.bitwise_or.reduce(self.matrix, axis=1).astype(np.int64) | 1 << MAX_OCTAVE
        return np.log2(every & -every).astype(np.int64)

    def values(self, octaves: Int64Array, drawn: bool) -> AnyArray:
        """(rows, columns) weights, or symbols by these octaves, less what draws tell of them."""
        if self.step is None:
            return self.matrix
        symbols = self.matrix >> octaves[:, None]
        return symbols - told(self.drawn, self.reach, octaves[:, None]) if drawn else symbols
