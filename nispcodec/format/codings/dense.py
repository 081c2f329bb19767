"""Dense: all values in row-major order, as the smallest number kind that holds them exactly."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray

from nispcodec.format.codings import numbers
from nispcodec.format.codings.reader import Reader


def encode(values: NDArray[Any]) -> bytes | None:
    """(rows, columns) float32 weights or int32 symbols -> payload."""
    return numbers.encode(values.ravel())


def decode(reader: Reader, shape: tuple[int, int], symbols: bool) -> NDArray[Any]:
    """Payload -> (rows, columns)."""
    count = shape[0] * shape[1]
    return numbers.decode(reader, count, symbols).reshape(shape)
