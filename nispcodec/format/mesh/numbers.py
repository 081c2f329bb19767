"""Integers as bits: how long they are as against what is expected, then their sign and digits."""

from __future__ import annotations

from typing import NamedTuple

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder

LONGEST = 24
STEPS_UP = 16
SIGN, DIGIT, UP, FURTHER_UP, DOWN = 0, 1, 2, 3, 20
"""Slots of a kind of number, counted from its first: of `FURTHER_UP` 16, of `DOWN` 24."""


class Context(NamedTuple):
    """Knowledge beside a number: how long it should be, and the contexts of the coder."""

    length: int
    general: int = 0
    medium: int = 0
    special: int = 0


def signed(coder: BinaryCoder, value: int, slot: int, context: Context) -> int:
    """An integer of up to 24 bits; `slot` is the first of 64. Raises FormatError for longer."""
    length = _length(coder, abs(value).bit_length(), slot, context)
    if length == 0:
        return 0
    negative = coder.bit(value < 0, slot + SIGN, 0, context.medium, context.special)
    found, rest = 1, abs(value)
    if length > 1:
        relative = clamp(length - context.length + 4, 0, 8)
        digit = rest >> length - 2 & 1
        found = 2 | coder.bit(digit, slot + DIGIT, relative, relative << 5 | length, relative)
        left = length - 2
        found = found << left | coder.bits(rest & (1 << left) - 1, left)
    return -found if negative else found


def _length(coder: BinaryCoder, length: int, slot: int, context: Context) -> int:
    found, *contexts = context
    if coder.bit(length > found, slot + UP, *contexts):
        found += 1
        step = 0
        while coder.bit(length > found, slot + FURTHER_UP + step, *contexts):
            found += 1
            step = min(step + 1, STEPS_UP - 1)
            if found > LONGEST:
                raise FormatError(SECTION, "number", f"at most {LONGEST} bits", "more")
        return found
    step = 0
    while found > 0 and coder.bit(length < found, slot + DOWN + step, *contexts):
        found -= 1
        step += 1
    return found


def coordinate(
    coder: BinaryCoder, value: int, expected: int, top: int, slot: int, context: Context
) -> tuple[int, int]:
    """An integer from 0 to `top`, near an expected one; and how much longer their difference is.

    The latter is from 1 to 10, 4 where it is as long as the context says. Raises FormatError.
    """
    guess = clamp(expected, 0, top)
    rest = signed(coder, value - guess, slot, context)
    if not 0 <= guess + rest <= top:
        raise FormatError(SECTION, "coordinate", f"0 to {top}", guess + rest)
    return guess + rest, clamp(abs(rest).bit_length() - context.length + 4, 1, 10)


def clamp(value: int, low: int, high: int) -> int:
    """The nearest integer in a range."""
    return min(max(value, low), high)


def over(number: int, divisor: int) -> int:
    """The nearest integer to a quotient, of two the higher; the divisor is not 0."""
    return (2 * number + divisor) // (2 * divisor)


def shortened(values: list[int], bits: int) -> list[int]:
    """All without as many of their last bits that the largest has at most `bits`."""
    shift = max(max(map(abs, values)).bit_length() - bits, 0)
    return [value >> shift for value in values]


def quarter(scale: int) -> int:
    """The two bits after the first one of a scale."""
    return (scale << 2 >> scale.bit_length() - 1) & 3 if scale else 0
