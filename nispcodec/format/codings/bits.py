"""A run of unsigned integers of given widths as one bit string, most significant bit first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nispcodec.format.codings.reader import Reader

Unsigned = NDArray[np.uint32]
Widths = NDArray[np.uint8]


def encode(values: Unsigned, widths: Widths) -> bytes:
    """(n,) integers below 2^width, (n,) widths up to 32 -> bytes, zero bits after the last."""
    starts = np.cumsum(widths, dtype=np.int64) - widths
    bits = np.zeros(int(widths.sum(dtype=np.int64)), np.uint8)
    for place in range(int(widths.max(initial=0))):
        holds = widths > place
        bits[starts[holds] + widths[holds] - 1 - place] = (values[holds] >> place) & 1
    return np.packbits(bits).tobytes()


def decode(reader: Reader, name: str, widths: Widths) -> Unsigned:
    """The inverse of `encode`; the bits after the last integer must be zero."""
    starts = np.cumsum(widths, dtype=np.int64) - widths
    total = int(widths.sum(dtype=np.int64))
    bits = np.unpackbits(np.frombuffer(reader.take((total + 7) // 8, name), np.uint8))
    if bits[total:].any():
        raise reader.error(name, "zero bits at the end", "a set bit")
    values = np.zeros(len(widths), np.uint32)
    for place in range(int(widths.max(initial=0))):
        holds = widths > place
        values[holds] = values[holds] << 1 | bits[starts[holds] + place]
    return values
