"""Compressed sparse rows: how many values each row has, their column gaps, the values."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings import indices, numbers
from nispcodec.format.codings.reader import Reader


def encode(values: AnyArray) -> bytes:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    mask = values != 0
    counts = indices.encode(indices.row_counts(mask), values.shape[1])
    gaps = indices.encode(indices.to_gaps(mask), values.shape[1] - 1)
    return counts + gaps + numbers.encode(values[mask])


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
    """Payload -> (rows, columns) float32, or int32 where `symbols`.

    Raises FormatError for positions outside the matrix.
    """
    counts = indices.decode(reader, "row_count", shape[0], shape[1])
    gaps = indices.decode(reader, "column_gap", int(counts.sum()), shape[1] - 1)
    columns = indices.from_gaps(reader, counts, gaps, shape[1])
    matrix = np.zeros(shape, np.int32 if symbols else np.float32)
    rows = np.repeat(np.arange(shape[0]), counts)
    matrix[rows, columns] = numbers.decode(reader, len(gaps), symbols)
    return matrix
