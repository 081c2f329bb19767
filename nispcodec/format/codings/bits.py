"""A run of unsigned integers of given widths as one bit string, most significant bit first."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Uint8Array, Uint32Array
from nispcodec.format.codings.reader import Reader


def encode(values: Uint32Array, widths: Uint8Array) -> bytes:
    """(n,) integers below 2^width, (n,) widths up to 32 -> bytes, zero bits after the last."""
    starts = np.cumsum(widths, dtype=np.int64) - widths
    bits = np.zeros(int(widths.sum(dtype=np.int64)), np.uint8)
    for place in range(int(widths.max(initial=0))):
        holds = widths > place
        bits[starts[holds] + widths[holds] - 1 - place] = (values[holds] >> place) & 1
    return np.packbits(bits).tobytes()


def decode(reader: Reader, name: str, widths: Uint8Array) -> Uint32Array:
    """The inverse of `encode`. Raises FormatError where a bit after the last integer is not 0."""
    ends = np.cumsum(widths, dtype=np.int64)
    total = int(ends[-1]) if len(ends) else 0
    data = np.frombuffer(reader.take((total + 7) // 8, name), np.uint8)
    if total % 8 and data[-1] & (0xFF >> total % 8):
        raise reader.error(name, "zero bits at the end", "a set bit")
    # Five bytes hold any 32 bits, wherever in a byte they begin.
    starts = ends - widths
    padded = np.concatenate([data, np.zeros(5, np.uint8)]).astype(np.uint64)
    window = np.zeros(len(widths), np.uint64)
    for byte in range(5):
        window = window << np.uint64(8) | padded[(starts >> 3) + byte]
    shift = (40 - (starts & 7) - widths).astype(np.uint64)
    mask = (np.uint64(1) << widths.astype(np.uint64)) - np.uint64(1)
    return (window >> shift & mask).astype(np.uint32)
