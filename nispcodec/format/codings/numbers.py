"""A run of numbers: one byte for their kind, then little-endian values of that kind."""

from __future__ import annotations

from typing import Any

import numpy as np

from nispcodec.core.arrays import AnyArray
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import NUMBERS

Kinds = dict[str, np.dtype[Any]]
FLOATS: Kinds = {"float16": np.dtype("<f2"), "float32": np.dtype("<f4")}
INTEGERS: Kinds = {"int8": np.dtype("i1"), "int16": np.dtype("<i2"), "int32": np.dtype("<i4")}


def smallest(values: AnyArray) -> str:
    """The smallest kind that holds (n,) float32 or int32 values exactly."""
    kinds = FLOATS if values.dtype.kind == "f" else INTEGERS
    with np.errstate(over="ignore"):
        return next(
            name
            for name, dtype in kinds.items()
            if (values.astype(dtype).astype(values.dtype) == values).all()
        )


def encode(values: AnyArray) -> bytes:
    """(n,) float32 or int32 -> bytes, in the smallest kind that loses nothing."""
    kind = smallest(values)
    stored = values.astype((FLOATS | INTEGERS)[kind])
    return bytes([1 + NUMBERS.index(kind)]) + stored.tobytes()


def decode(reader: Reader, count: int, symbols: bool) -> AnyArray:
    """Bytes -> (count,) float32, or int32 where `symbols`.

    Raises FormatError for a kind of the other sort, and for too few bytes.
    """
    kinds = INTEGERS if symbols else FLOATS
    name = reader.member("number_kind", NUMBERS, tuple(kinds))
    values = np.frombuffer(reader.take(count * kinds[name].itemsize, "values"), kinds[name])
    return values.astype(np.int32 if symbols else np.float32)
