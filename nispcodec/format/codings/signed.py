"""Weights as signed magnitudes: symbols as they are, floats counted down from the largest.

A float's magnitude is 0 for zero, else top + 1 - pattern, where pattern is its bits without the
sign and top the largest pattern in the tensor: large weights, which are common, come out small.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from nispcodec.format.codings.numbers import FLOATS, Kinds, smallest
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.codings.tokens import Magnitudes
from nispcodec.format.constants import NUMBERS

_PATTERNS: Kinds = {"float16": np.dtype("<u2"), "float32": np.dtype("<u4")}
_SIGNS = {"float16": 0x8000, "float32": 0x80000000}
_INFINITIES = {"float16": 0x7C00, "float32": 0x7F800000}


def encode(values: NDArray[Any]) -> tuple[bytes, Magnitudes]:
    """(n,) float32 weights or int32 symbols -> what the decoder needs to know, (n,) magnitudes."""
    if values.dtype.kind != "f":
        return b"", np.abs(values).astype(np.uint32)
    kind = smallest(values)
    pattern = values.astype(FLOATS[kind]).view(_PATTERNS[kind]).astype(np.uint32)
    pattern &= np.uint32(_SIGNS[kind] - 1)
    top = int(pattern.max())
    magnitudes = np.where(pattern > 0, top + 1 - pattern, 0).astype(np.uint32)
    return bytes([1 + NUMBERS.index(kind)]) + varint(top), magnitudes


def read_top(reader: Reader) -> tuple[str, int]:
    """Number kind and largest pattern of a float tensor."""
    kind = reader.member("number kind", NUMBERS, tuple(FLOATS))
    return kind, reader.varint("top", _INFINITIES[kind] - 1)


def decode_floats(
    kind: str, top: int, magnitudes: Magnitudes, negative: NDArray[np.bool_]
) -> NDArray[np.float32]:
    """(n,) magnitudes up to `top` and signs -> (n,) weights."""
    pattern = np.where(magnitudes > 0, np.uint32(top + 1) - magnitudes, np.uint32(0))
    signed = pattern | negative * np.uint32(_SIGNS[kind])
    stored: NDArray[Any] = signed.astype(_PATTERNS[kind]).view(FLOATS[kind])
    return stored.astype(np.float32)


def decode_symbols(magnitudes: Magnitudes, negative: NDArray[np.bool_]) -> NDArray[np.int32]:
    """(n,) magnitudes below 2^31 and signs -> (n,) symbols."""
    signed = magnitudes.astype(np.int32)
    return np.where(negative, -signed, signed)
