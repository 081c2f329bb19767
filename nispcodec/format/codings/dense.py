"""Dense: every value, in row-major order."""

from __future__ import annotations

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings import numbers
from nispcodec.format.codings.reader import Reader


def encode(values: AnyArray) -> bytes:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    return numbers.encode(values.ravel())


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> AnyArray:
    """Payload -> (rows, columns) float32, or int32 where `symbols`.

    Raises FormatError for too few bytes.
    """
    return numbers.decode(reader, shape[0] * shape[1], symbols).reshape(shape)
