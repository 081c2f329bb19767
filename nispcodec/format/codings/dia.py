"""Diagonals: which ones hold a value that is not zero, then all values of each, zeros included.

Diagonal d, from 0 to rows + columns - 2, holds the places with column - row = d - (rows - 1); its
values run from the top row down.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray, Int64Array
from nispcodec.format.codings import indices, numbers
from nispcodec.format.codings.reader import Reader, varint


def encode(values: AnyArray) -> bytes:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    number = _diagonals(values.shape)
    used = np.unique(number[values != 0])
    gaps = indices.encode(np.diff(used, prepend=-1) - 1, number.max())
    order = _order(number, used)
    return varint(len(used)) + gaps + numbers.encode(values.ravel()[order])


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
    """Payload -> (rows, columns) float32, or int32 where `symbols`.

    Raises FormatError for diagonals outside the matrix.
    """
    number = _diagonals(shape)
    last = shape[0] + shape[1] - 2
    count = reader.varint("diagonal_count", last + 1)
    used = np.cumsum(indices.decode(reader, "diagonal_gap", count, last) + 1) - 1
    if count and used[-1] > last:
        raise reader.error("diagonal", f"at most {last}", used[-1])
    order = _order(number, used)
    matrix = np.zeros(shape, np.int32 if symbols else np.float32)
    matrix.ravel()[order] = numbers.decode(reader, len(order), symbols)
    return matrix


def _diagonals(shape: tuple[int, ...]) -> Int64Array:
    """(rows, columns): the number of the diagonal through each place."""
    rows, columns = np.indices(shape)
    number: Int64Array = columns - rows + shape[0] - 1
    return number


def _order(number: Int64Array, used: Int64Array) -> Int64Array:
    """Row-major places on the used diagonals, diagonal after diagonal, each from the top."""
    flat = number.ravel()
    order = np.argsort(flat, kind="stable")
    return order[np.isin(flat[order], used)]
