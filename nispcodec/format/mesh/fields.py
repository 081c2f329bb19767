"""Single numbers: counts, floats, members of small sets."""

from __future__ import annotations

import struct
from math import inf, isfinite

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder

LENGTH_BITS = 5
SINGLE_BITS = 32


def number(coder: BinaryCoder, value: int, maximum: int, name: str) -> int:
    """An integer below 2^31: how many bits it has, then these without the first one.

    Raises FormatError for one above `maximum`.
    """
    length = coder.bits(value.bit_length(), LENGTH_BITS)
    rest = coder.bits(value & (1 << length >> 1) - 1, max(length - 1, 0))
    found = (1 << length >> 1) + rest
    if found > maximum:
        raise FormatError(SECTION, name, f"at most {maximum}", found)
    return found


def flag(coder: BinaryCoder, value: bool, slot: int) -> bool:
    """Yes or no, likely what it was in the parts before."""
    return bool(coder.bit(value, slot, 0, 0, 0))


def single(coder: BinaryCoder, value: float, slot: int, name: str) -> float:
    """A float32, with flags for 0 and 1; takes slots from `slot` on. Raises FormatError."""
    if flag(coder, value == 0, slot):
        return 0.0
    if flag(coder, value == 1, slot + 1):
        return 1.0
    (found,) = struct.unpack("<f", struct.pack("<I", coder.bits(_pattern(value), SINGLE_BITS)))
    if not isfinite(found):
        raise FormatError(SECTION, name, "a finite number", found)
    return float(found)


def _pattern(value: float) -> int:
    """The bits of the nearest float32, infinite where there is none."""
    try:
        packed = struct.pack("<f", value)
    except OverflowError:
        packed = struct.pack("<f", inf)
    return int.from_bytes(packed, "little")


def member(coder: BinaryCoder, value: int, bits: int, last: int) -> int:
    """An integer of `bits` bits, after `last` in its list, where few values come often."""
    node = 1
    for place in range(bits - 1, -1, -1):
        bit = coder.bit(value >> place & 1, slots.MEMBER, node, node, node << 3 | last & 7)
        node = node << 1 | bit
    return node - (1 << bits)
