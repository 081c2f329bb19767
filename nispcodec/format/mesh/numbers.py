"""Integers as bits: how long they are as against what is expected, then their sign and digits."""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder

LONGEST = 24


def signed(
    coder: BinaryCoder,
    value: int,
    slot: int,
    expected: int,
    general: int,
    medium: int,
    special: int,
) -> int:
    """An integer of up to 24 bits; `expected` is how long it should be, 0 to 24.

    slot: the first of 64 slots; medium, special: contexts. Raises FormatError for a longer one.
    """
    length = _length(coder, abs(value).bit_length(), slot, expected, general, medium, special)
    if length == 0:
        return 0
    relative = min(max(length - expected, -4), 4) + 4
    negative = coder.bit(value < 0, slot + 1, 0, medium, special)
    size = 1
    rest = abs(value)
    if length > 1:
        second = rest >> length - 2 & 1
        size = 2 | coder.bit(second, slot + 2, relative, relative << 5 | length, relative)
    for place in range(length - 3, -1, -1):
        size = size << 1 | coder.bits(rest >> place & 1, 1)
    return -size if negative else size


def _length(
    coder: BinaryCoder,
    length: int,
    slot: int,
    expected: int,
    general: int,
    medium: int,
    special: int,
) -> int:
    found = expected
    if coder.bit(length > found, slot + 3, general, medium, special):
        found += 1
        step = 0
        while coder.bit(length > found, slot + 4 + step, general, medium, special):
            found += 1
            step = min(step + 1, 15)
            if found > LONGEST:
                raise FormatError(SECTION, "number", f"at most {LONGEST} bits", "more")
        return found
    step = 0
    while found > 0 and coder.bit(length < found, slot + 20 + step, general, medium, special):
        found -= 1
        step += 1
    return found
