"""Positions of the values that are not zero: small integers, sized to the matrix.

Columns are gaps: how many zeros lie before a value, counted from the value before it in its row,
or from the row's start.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from nispcodec.core.arrays import BoolArray, Int64Array
from nispcodec.format.codings.reader import Reader


def encode(values: Int64Array, maximum: int) -> bytes:
    """(n,) integers from 0 to `maximum` -> little-endian, 1, 2 or 4 bytes each."""
    return values.astype(_kind(maximum)).tobytes()


def decode(reader: Reader, name: str, count: int, maximum: int) -> Int64Array:
    """The inverse of `encode`. Raises FormatError for an integer beyond `maximum`."""
    kind = _kind(maximum)
    values = np.frombuffer(reader.take(count * kind.itemsize, name), kind).astype(np.int64)
    if count and values.max() > maximum:
        raise reader.error(name, f"at most {maximum}", values.max())
    return values


def row_counts(mask: BoolArray) -> Int64Array:
    """(rows, columns) bool -> (rows,) how many are set in each row."""
    return np.count_nonzero(mask, axis=1).astype(np.int64)


def to_gaps(mask: BoolArray) -> Int64Array:
    """(rows, columns) bool -> (n,) the gap before each set place, row after row."""
    rows, columns = np.nonzero(mask)
    previous = np.concatenate([[-1], columns[:-1]])
    first = np.concatenate([[True], rows[1:] != rows[:-1]])[: len(rows)]
    gaps: Int64Array = columns - np.where(first, -1, previous[: len(rows)]) - 1
    return gaps


def from_gaps(reader: Reader, counts: Int64Array, gaps: Int64Array, columns: int) -> Int64Array:
    """Counts (rows,) and gaps (n,) -> columns (n,). Raises FormatError outside the matrix."""
    ends = np.cumsum(gaps + 1)
    before = np.concatenate([[0], ends])[np.cumsum(counts) - counts]
    found = ends - np.repeat(before, counts) - 1
    if len(found) and found.max() >= columns:
        raise reader.error("column", f"below {columns}", found.max())
    return found


def _kind(maximum: int) -> np.dtype[Any]:
    if maximum < 2**8:
        return np.dtype("u1")
    return np.dtype("<u2") if maximum < 2**16 else np.dtype("<u4")
