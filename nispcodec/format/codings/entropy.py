"""Entropy: the tensors of one network that take this coding share tables and one rANS stream.

Sharing matters: a table and a stream for each of a network's small tensors would cost 4 percent.
A tensor's own record is its head; the pool of them all follows the network's last tensor.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nispcodec.format.codings import bits, rans, signed, tables, tokens
from nispcodec.format.codings.reader import Reader
from nispcodec.format.codings.tables import Counts
from nispcodec.format.constants import MAX_SYMBOL, MAX_TOKENS


@dataclass(frozen=True)
class Head:
    """A tensor's record: how many values of which kind (None: symbols), how large, which table."""

    count: int
    kind: str | None
    top: int
    table: int


class Pool:
    """The tensors to code together: (n,) arrays of float32 weights or int32 symbols."""

    def __init__(self, tensors: list[NDArray[Any]]) -> None:
        self._negative = [values < 0 for values in tensors]
        self._heads, self._magnitudes = zip(*map(signed.encode, tensors), strict=True)
        self._tokens = [tokens.from_magnitudes(magnitudes) for magnitudes in self._magnitudes]

    @cached_property
    def _histograms(self) -> list[Counts]:
        return [np.bincount(run, minlength=MAX_TOKENS) for run in self._tokens]

    @cached_property
    def _groups(self) -> list[list[int]]:
        return tables.share(self._histograms)

    @cached_property
    def _tables(self) -> list[list[int]]:
        return [
            tables.levels(np.sum([self._histograms[i] for i in group], axis=0))
            for group in self._groups
        ]

    @cached_property
    def _table_of(self) -> dict[int, int]:
        return {i: table for table, group in enumerate(self._groups) for i in group}

    def heads(self) -> list[bytes]:
        """The record of every tensor."""
        return [head + bytes([self._table_of[i]]) for i, head in enumerate(self._heads)]

    def sizes(self) -> list[float]:
        """Bytes that each tensor takes, the common tables left out."""
        return [
            len(head) + (self._token_bits(i) + self._other_bits(i)) / 8
            for i, head in enumerate(self.heads())
        ]

    def encode(self) -> bytes:
        """Tables, rANS words, signs of what is not zero, extra bits: of all tensors."""
        frequencies = [tables.frequencies(table) for table in self._tables]
        runs = [
            (run.tobytes(), frequencies[self._table_of[i]]) for i, run in enumerate(self._tokens)
        ]
        head = bytes([len(self._tables)]) + b"".join(map(tables.encode, self._tables))
        magnitudes = np.concatenate(self._magnitudes)
        signs = np.concatenate(self._negative)[magnitudes > 0].astype(np.uint32)
        widths = tokens.extra_bits(np.concatenate(self._tokens))
        rest = magnitudes & ((np.uint32(1) << widths) - np.uint32(1))
        coded_signs = bits.encode(signs, np.ones(len(signs), np.uint8))
        return head + rans.encode(runs) + coded_signs + bits.encode(rest, widths)

    def _token_bits(self, i: int) -> float:
        return tables.coded_bits(self._histograms[i], self._tables[self._table_of[i]])

    def _other_bits(self, i: int) -> int:
        signs = int(np.count_nonzero(self._magnitudes[i]))
        return signs + int(tokens.extra_bits(self._tokens[i]).sum(dtype=np.int64))


def read_head(reader: Reader, count: int, symbols: bool) -> Head:
    """A tensor's record."""
    kind, top = (None, MAX_SYMBOL) if symbols else signed.read_top(reader)
    return Head(count, kind, top, reader.take(1, "table")[0])


def decode(reader: Reader, heads: list[Head]) -> list[NDArray[Any]]:
    """The pool -> (n,) float32 weights or int32 symbols of every tensor."""
    frequencies = _read_tables(reader, max(head.table for head in heads))
    coded = rans.decode(reader, [(head.count, frequencies[head.table]) for head in heads])
    all_tokens = np.frombuffer(coded, np.uint8)
    nonzero = all_tokens > 0
    negative = np.zeros(len(all_tokens), np.bool_)
    negative[nonzero] = bits.decode(reader, "signs", np.ones(nonzero.sum(), np.uint8)) > 0
    rest = bits.decode(reader, "extra bits", tokens.extra_bits(all_tokens))
    magnitudes = tokens.smallest(all_tokens) + rest
    ends = np.cumsum([head.count for head in heads])[:-1]
    return [
        _values(reader, head, *parts)
        for head, *parts in zip(
            heads, np.split(magnitudes, ends), np.split(negative, ends), strict=True
        )
    ]


def _read_tables(reader: Reader, last: int) -> list[list[int]]:
    count = reader.take(1, "table count")[0]
    if count != last + 1:
        raise reader.error("table count", last + 1, count)
    return [tables.frequencies(tables.decode(reader)) for _ in range(count)]


def _values(
    reader: Reader, head: Head, magnitudes: tokens.Magnitudes, negative: NDArray[np.bool_]
) -> NDArray[Any]:
    if magnitudes.max() > head.top:
        raise reader.error("magnitude", f"at most {head.top}", magnitudes.max())
    if head.kind is None:
        return signed.decode_symbols(magnitudes, negative)
    return signed.decode_floats(head.kind, head.top, magnitudes, negative)
