"""Compressed sparse columns: CSR of the transposed matrix."""

from __future__ import annotations

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings import csr
from nispcodec.format.codings.reader import Reader


def encode(values: AnyArray) -> bytes:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    return csr.encode(values.T)


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
    """Payload -> (rows, columns) float32, or int32 where `symbols`.

    Raises FormatError for positions outside the matrix.
    """
    return csr.decode(reader, (shape[1], shape[0]), symbols).T
