"""A quantisation step in the fewest bytes: none if as before, one byte, float16 or float32."""

from __future__ import annotations

import struct

import numpy as np

from nispcodec.errors import FormatError
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import NETS

_FORMATS = {"float16": "<e", "float32": "<f"}
_BYTE = {(8 + byte % 8) * 2.0 ** (byte // 8 - 30): byte for byte in range(256)}
_VALUES = list(_BYTE)


def encode(path: str, step: float, before: float | None) -> tuple[str, bytes]:
    """Form and bytes of a step; `before` is that of the record before, if it has one."""
    single = float(np.float32(step))
    if not 0 < single < np.inf:
        raise FormatError(NETS, f"{path}.step", "a positive float32", step)
    if before is not None and single == float(np.float32(before)):
        return "same", b""
    if single in _BYTE:
        return "byte", bytes([_BYTE[single]])
    with np.errstate(over="ignore"):
        form = "float16" if float(np.float16(single)) == single else "float32"
    return form, struct.pack(_FORMATS[form], single)


def decode(reader: Reader, form: str, before: float | None) -> float:
    """The inverse of `encode`."""
    if form == "same":
        if before is None:
            raise reader.error("step", "a step in the record before", "none")
        return before
    if form == "byte":
        return _VALUES[reader.take(1, "step")[0]]
    size = struct.calcsize(_FORMATS[form])
    step = float(struct.unpack(_FORMATS[form], reader.take(size, "step"))[0])
    if not 0 < step < np.inf:
        raise reader.error("step", "a positive number", step)
    return step
