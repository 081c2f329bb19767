"""Weights as signed integers: symbols as they are, floats counted down from the largest.

A float's magnitude is 0 for zero, else top + 1 - pattern, where pattern is its bits without the
sign and top the largest pattern of its run: large weights, which are common, come out small.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array, Int64Array
from nispcodec.format.codings.numbers import FLOATS, Kinds, smallest
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.constants import NUMBERS

_PATTERNS: Kinds = {"float16": np.dtype("<u2"), "float32": np.dtype("<u4")}
_SIGNS = {"float16": 0x8000, "float32": 0x80000000}
_INFINITIES = {"float16": 0x7C00, "float32": 0x7F800000}


def encode(values: AnyArray) -> tuple[bytes, Int64Array]:
    """(n,) float32 weights or int32 symbols -> what the decoder needs to know, (n,) int64."""
    if values.dtype.kind != "f":
        return b"", values.astype(np.int64)
    kind = smallest(values)
    stored = values.astype(FLOATS[kind]).view(_PATTERNS[kind]).astype(np.int64)
    pattern = stored & _SIGNS[kind] - 1
    top = int(pattern.max())
    magnitude = np.where(pattern > 0, top + 1 - pattern, 0)
    signed = np.where(stored >= _SIGNS[kind], -magnitude, magnitude)
    return bytes([1 + NUMBERS.index(kind)]) + varint(top), signed


def read_top(reader: Reader) -> tuple[str, int]:
    """Number kind and largest pattern of a run of floats. Raises FormatError for other bytes."""
    kind = reader.member("number_kind", NUMBERS, tuple(FLOATS))
    return kind, reader.varint("top", _INFINITIES[kind] - 1)


def decode_floats(kind: str, top: int, integers: Int64Array) -> Float32Array:
    """(n,) integers of magnitudes up to `top` -> (n,) float32 weights of a number kind."""
    pattern = np.where(integers != 0, top + 1 - np.abs(integers), 0)
    stored = np.where(integers < 0, pattern | _SIGNS[kind], pattern).astype(_PATTERNS[kind])
    values: AnyArray = stored.view(FLOATS[kind])
    return values.astype(np.float32)
