"""Coordinates: row (a step from the row before) and column gap of every value, then the values."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings import indices, numbers
from nispcodec.format.codings.reader import Reader, varint


def encode(values: AnyArray) -> bytes:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    mask = values != 0
    rows = np.nonzero(mask)[0]
    row_steps = indices.encode(np.diff(rows, prepend=0), values.shape[0] - 1)
    gaps = indices.encode(indices.to_gaps(mask), values.shape[1] - 1)
    return varint(len(rows)) + row_steps + gaps + numbers.encode(values[mask])


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
    """Payload -> (rows, columns) float32, or int32 where `symbols`.

    Raises FormatError for positions outside the matrix.
    """
    count = reader.varint("count", shape[0] * shape[1])
    rows = np.cumsum(indices.decode(reader, "row_step", count, shape[0] - 1))
    if count and rows[-1] >= shape[0]:
        raise reader.error("row", f"below {shape[0]}", rows[-1])
    gaps = indices.decode(reader, "column_gap", count, shape[1] - 1)
    columns = indices.from_gaps(reader, np.bincount(rows, minlength=shape[0]), gaps, shape[1])
    matrix = np.zeros(shape, np.int32 if symbols else np.float32)
    matrix[rows, columns] = numbers.decode(reader, count, symbols)
    return matrix
