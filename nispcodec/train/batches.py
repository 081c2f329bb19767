"""Which samples each step learns from."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import FloatArray, Int32Array


class Batches:
    """Rounds of all `count` samples in random order; a batch never straddles two rounds.

    Where there are hard examples, every other sample is one of these, by its hardness.
    """

    def __init__(self, count: int, size: int, random: np.random.Generator) -> None:
        self._count, self._size, self._random = count, min(size, count), random
        self._hard = np.zeros(0, dtype=np.int32)
        self._order = np.zeros(0, dtype=np.int32)

    def take(self, steps: int) -> Int32Array:
        """The samples (steps, size) of the next steps."""
        return np.stack([self._next() for _ in range(steps)])

    def prefer(self, hardness: FloatArray) -> None:
        """From now on; (count,), 0 for a sample that is not hard. A new round begins."""
        self._hard = np.flatnonzero(hardness).astype(np.int32)
        weights = hardness[self._hard].astype(np.float64)
        self._shares = weights / weights.sum() if len(weights) else weights
        self._order = self._order[:0]

    def _next(self) -> Int32Array:
        if len(self._order) < self._size:
            self._order = self._round()
        batch, self._order = self._order[: self._size], self._order[self._size :]
        return batch

    def _round(self) -> Int32Array:
        order = self._random.permutation(np.int32(self._count)).astype(np.int32)
        if not len(self._hard):
            return order
        # How often each is drawn, then their order: one by one it takes ten times as long.
        again = np.repeat(self._hard, self._random.multinomial(self._count, self._shares))
        return np.stack([order, self._random.permutation(again)], axis=1).ravel()
