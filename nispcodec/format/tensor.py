"""A tensor to write: its symbols, and how much of them initial weights and row shifts imply."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import AnyArray, Int64Array
from nispcodec.core.initial_weights import BITS, predicted
from nispcodec.core.network import MAX_ROW_SHIFT
from nispcodec.format.constants import MAX_SYMBOL


@dataclass(frozen=True)
class Tensor:
    """One tensor of a network as a matrix; a bias is one row.

    path    network and tensor, for errors
    step    quantization step, None where weights are not quantized
    matrix  (rows, columns) float32 weights, or int32 symbols
    initial (rows, columns) integers of `nispcodec.core.initial_weights`
    """

    path: str
    step: float | None
    matrix: AnyArray
    initial: Int64Array

    @cached_property
    def init_scale(self) -> int:
        """The scale with which initial weights predict symbols best; 0 where they do not."""
        if self.step is None or not self.initial.any():
            return 0
        shares = self.initial / (1 << BITS)
        fitted = float((self.matrix * shares).sum() / (shares * shares).sum())
        scale = min(max(round(fitted), 0), MAX_SYMBOL)
        far = np.abs(self.matrix - predicted(self.initial, scale, np.zeros(1, np.int64))).max()
        return scale if far <= MAX_SYMBOL else 0

    @cached_property
    def row_shifts(self) -> Int64Array:
        """(rows,) int64: the largest power of two that divides all symbols of each row.

        At most MAX_ROW_SHIFT, and 0 where weights are not quantized.
        """
        if self.step is None:
            return np.zeros(len(self.matrix), np.int64)
        every = np.bitwise_or.reduce(self.matrix, axis=1).astype(np.int64) | 1 << MAX_ROW_SHIFT
        return np.log2(every & -every).astype(np.int64)

    def values(self, row_shifts: Int64Array, delta: bool) -> AnyArray:
        """(rows, columns): the weights, or the symbols shifted right by row_shifts (rows,).

        With `delta` the symbols are less what the initial weights predict.
        """
        if self.step is None:
            return self.matrix
        symbols = self.matrix >> row_shifts[:, None]
        if not delta:
            return symbols
        return symbols - predicted(self.initial, self.init_scale, row_shifts[:, None])
