"""A quantization step in the fewest bytes: none if as before, one byte, float16 or float32.

Where some rows need less precision, their symbols are multiples of a power of two: the row shift.
"""

from __future__ import annotations

import struct

import numpy as np

from nispcodec.core.arrays import Int64Array, IntArray
from nispcodec.core.errors import FormatError
from nispcodec.format.codings import bits
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import NETS

_FORMATS = {"float16": "<e", "float32": "<f"}
_BYTE = {(8 + byte % 8) * 2.0 ** (byte // 8 - 30): byte for byte in range(256)}
_VALUES = list(_BYTE)


def has_row_shifts(step: float) -> bool:
    """Whether rows may have row shifts beside this step: it must fit in one byte."""
    return float(np.float32(step)) in _BYTE


def encode(
    path: str, step: float, before: float | None, row_shifts: IntArray, width: int
) -> tuple[str, bytes]:
    """Form, one of `STEPS`, and bytes of a step and its row shifts.

    `before` is the step of the record before, None if it has none. row_shifts (rows,) are written
    in `width` bits each, and not at all where that is 0. Raises FormatError, naming the tensor at
    `path`, for a step that is no positive float32.
    """
    single = float(np.float32(step))
    if not 0 < single < np.inf:
        raise FormatError(NETS, f"{path}.step", "a positive float32", step)
    if width:
        widths = np.full(len(row_shifts), width, np.uint8)
        return f"rows{width}", bytes([_BYTE[single]]) + bits.encode(
            row_shifts.astype(np.uint32), widths
        )
    if before is not None and single == float(np.float32(before)):
        return "same", b""
    if single in _BYTE:
        return "byte", bytes([_BYTE[single]])
    with np.errstate(over="ignore"):
        form = "float16" if float(np.float16(single)) == single else "float32"
    return form, struct.pack(_FORMATS[form], single)


def decode_row_shifts(reader: Reader, form: str, rows: int) -> Int64Array:
    """The row shifts (rows,) that follow a step; all 0 where its form has none.

    Raises FormatError at the reader's place.
    """
    if not form.startswith("rows"):
        return np.zeros(rows, np.int64)
    widths = np.full(rows, int(form.removeprefix("rows")), np.uint8)
    return bits.decode(reader, "row_shifts", widths).astype(np.int64)


def decode(reader: Reader, form: str, before: float | None) -> float:
    """The inverse of `encode`, but for row shifts. Raises FormatError at the reader's place."""
    if form == "same":
        if before is None:
            raise reader.error("step", "a step in the record before", "none")
        return before
    if form == "byte" or form.startswith("rows"):
        return _VALUES[reader.take(1, "step")[0]]
    size = struct.calcsize(_FORMATS[form])
    step = float(struct.unpack(_FORMATS[form], reader.take(size, "step"))[0])
    if not 0 < step < np.inf:
        raise reader.error("step", "a positive number", step)
    return step
