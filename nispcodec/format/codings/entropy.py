"""Entropy: runs of tensors, each with a frequency model, in one rANS stream at the section's end.

A stream for each of the small tensors of a network would cost 2 percent, and tables of frequencies
more than that. A run's own record is its header.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import AnyArray, Int64Array
from nispcodec.format.codings import bits, frequency_model, rans, signed
from nispcodec.format.codings.frequency_model import FrequencyModel
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.constants import MAX_SYMBOL

Coded = tuple[AnyArray, float]
"""Values of a run, and the bits that an ideal coder takes for them."""


class SymbolRun:
    """Values to write under one frequency model: (n,) float32 weights or int32 symbols."""

    def __init__(self, values: AnyArray) -> None:
        self._prefix, self._integers = signed.encode(values)
        self._magnitudes = np.abs(self._integers)
        self._limit = int(self._magnitudes.max())
        self._cells, self._open = frequency_model.cells(self._limit)

    @cached_property
    def _cell(self) -> Int64Array:
        return np.where(self._magnitudes > 0, (self._magnitudes - 1 >> self._open) + 1, 0)

    @cached_property
    def _fitted(self) -> tuple[FrequencyModel, float]:
        return frequency_model.fit(np.bincount(self._cell, minlength=self._cells + 1))

    def header(self) -> bytes:
        """The bytes of the run's record: number kind, largest magnitude, frequency model."""
        header = self._prefix + varint(self._limit)
        return header + self._fitted[0].encode() if self._limit else header

    def streamed(self) -> float:
        """Bytes that the run takes in the stream, by an ideal coder."""
        return self._fitted[1] / 8 + len(self.rest()) if self._limit else 0.0

    def tokens(self) -> tuple[list[int], list[int]]:
        """Start and frequency of every value's token, of `rans.SCALE` in all."""
        if not self._limit:
            return [], []
        starts = self._fitted[0].starts(self._cells)
        token = self._cells + np.sign(self._integers) * self._cell
        return starts[token].tolist(), np.diff(starts)[token].tolist()

    def rest(self) -> bytes:
        """The low bits that tokens leave open, for every value that is not zero."""
        above = (self._magnitudes[self._magnitudes > 0] - 1).astype(np.uint32)
        below = above & np.uint32((1 << self._open) - 1)
        return bits.encode(below, np.full(len(below), self._open, np.uint8))


def encode(runs: list[SymbolRun]) -> bytes:
    """The bytes of the stream: rANS words of all tokens, then the bits they leave open."""
    starts: list[int] = []
    frequencies: list[int] = []
    for run in runs:
        more_starts, more_frequencies = run.tokens()
        starts += more_starts
        frequencies += more_frequencies
    return rans.encode(starts, frequencies) + b"".join(run.rest() for run in runs)


@dataclass(frozen=True)
class RunHeader:
    """A run's record, as read.

    count   how many values
    kind    number kind of floats, None for symbols
    top     largest pattern of floats (see `signed`)
    limit   largest magnitude of the integers
    model   their frequency model, None where all are 0
    """

    count: int
    kind: str | None
    top: int
    limit: int
    model: FrequencyModel | None

    @property
    def coded(self) -> int:
        """How many tokens of the stream are the run's."""
        return self.count if self.limit else 0

    @cached_property
    def starts(self) -> Int64Array:
        """(tokens + 1,) int64: where the frequencies begin; without model one token, zero."""
        if self.model is None:
            return np.array([0, rans.SCALE])
        return self.model.starts(frequency_model.cells(self.limit)[0])


def read_header(reader: Reader, count: int, symbols: bool) -> RunHeader:
    """The record of a run of `count` values. Raises FormatError at the reader's place."""
    kind, top = (None, MAX_SYMBOL) if symbols else signed.read_top(reader)
    limit = reader.varint("limit", top)
    return RunHeader(count, kind, top, limit, frequency_model.decode(reader) if limit else None)


def decode(reader: Reader, headers: list[RunHeader]) -> list[Coded]:
    """The stream -> (n,) float32 weights or int32 symbols of every run, and the bits it took.

    Raises FormatError at the reader's place.
    """
    tokens = rans.decode(reader, [(header.coded, header.starts) for header in headers])
    ends = np.cumsum([header.coded for header in headers], dtype=np.int64)
    parts = np.split(tokens, ends)[:-1]
    return [
        (_values(reader, header, part), _bits(header, part))
        for header, part in zip(headers, parts, strict=True)
    ]


def _bits(header: RunHeader, tokens: Int64Array) -> float:
    cells, open_bits = frequency_model.cells(header.limit)
    shares = np.diff(header.starts)[tokens] / rans.SCALE
    return float(open_bits * np.count_nonzero(tokens != cells) - np.log2(shares).sum())


def _values(reader: Reader, header: RunHeader, tokens: Int64Array) -> AnyArray:
    integers = np.zeros(header.count, np.int64)
    if header.limit:
        integers = _integers(reader, header.limit, tokens)
    if header.kind is None:
        return integers.astype(np.int32)
    return signed.decode_floats(header.kind, header.top, integers)


def _integers(reader: Reader, limit: int, tokens: Int64Array) -> Int64Array:
    cells, open_bits = frequency_model.cells(limit)
    signs = np.sign(tokens - cells)
    magnitudes = np.abs(tokens - cells)
    if open_bits:
        above = magnitudes[signs != 0] - 1
        rest = bits.decode(reader, "open_bits", np.full(len(above), open_bits, np.uint8))
        magnitudes[signs != 0] = (above << open_bits) + rest + 1
    if magnitudes.max() > limit:
        raise reader.error("magnitude", f"at most {limit}", magnitudes.max())
    return signs * magnitudes
