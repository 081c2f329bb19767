"""Bits under adaptive, mixed probabilities in one range coder: one model for both directions.

Each bit is said in three contexts, from the general to the special. A counter for each of them
holds how likely a 1 was there; the three are mixed in the logistic domain by weights that learn,
too. A mesh part is a few hundred vertices: nothing can be learned from scratch, hence counters that
move quickly at first, and new ones that begin with what the more general context says.

The arithmetic is of integers, exact in doubles of 53 bits.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh.logistic import SQUASH, STRETCH
from nispcodec.format.mesh.priors import table

SECTION = "MESH"
_TOP = 1 << 24
_FULL = (1 << 32) - 1
LIMIT = 255
RATES = tuple(int(65536 / (n + 2)) for n in range(LIMIT + 1))
NEXT = tuple(min(n + 1, LIMIT) for n in range(LIMIT + 1))
LEARNING = 10
START = 20000
PRIORS = table()


class BinaryCoder(ABC):
    """The part that encoder and decoder share: counters, weights, the calls of all models.

    Every method takes the value to encode, of which a decoder takes no notice, and returns the
    value: models are written once.
    """

    encodes: bool

    def __init__(self) -> None:
        self._general: dict[int, list[int]] = {}
        self._medium: dict[int, list[int]] = {}
        self._special: dict[int, list[int]] = {}
        self._weights: dict[int, list[int]] = {}

    def bit(self, value: int, slot: int, general: int, medium: int, special: int) -> int:
        """One bit; `slot` says which decision it is (below 4096), the others its contexts."""
        first = self._general.get(slot << 20 | general)
        if first is None:
            first = self._general[slot << 20 | general] = list(PRIORS.get(slot, (32768, 0)))
        second = self._medium.get(slot << 20 | medium)
        if second is None:
            second = self._medium[slot << 20 | medium] = [first[0], 1]
        third = self._special.get(slot << 20 | special)
        if third is None:
            third = self._special[slot << 20 | special] = [first[0], 1]
        weights = self._weights.get(slot)
        if weights is None:
            weights = self._weights[slot] = [START, START, START]
        one, two, three = STRETCH[first[0] >> 4], STRETCH[second[0] >> 4], STRETCH[third[0] >> 4]
        mixed = (weights[0] * one + weights[1] * two + weights[2] * three) >> 16
        probability = SQUASH[2048 + (-2047 if mixed < -2047 else 2047 if mixed > 2047 else mixed)]
        bit = self._code(value, probability)
        target = 65535 if bit else 0
        miss = (target - probability) * LEARNING
        weights[0] += (one * miss + 32768) >> 16
        weights[1] += (two * miss + 32768) >> 16
        weights[2] += (three * miss + 32768) >> 16
        # A loop over the three would take a tenth of the time of all coding.
        likely, seen = first
        first[0] = likely + ((target - likely) * RATES[seen] >> 16)
        first[1] = NEXT[seen]
        likely, seen = second
        second[0] = likely + ((target - likely) * RATES[seen] >> 16)
        second[1] = NEXT[seen]
        likely, seen = third
        third[0] = likely + ((target - likely) * RATES[seen] >> 16)
        third[1] = NEXT[seen]
        return bit

    def bits(self, value: int, count: int) -> int:
        """An integer of `count` bits, up to 32, all values equally likely."""
        found = 0
        for place in range(count - 1, -1, -1):
            found = found << 1 | self._code(value >> place & 1, 32768)
        return found

    def below(self, value: int, end: int, name: str) -> int:
        """An integer from 0 to end - 1. Raises FormatError for a larger one, and for none."""
        found = self.bits(value, (end - 1).bit_length()) if end > 0 else 0
        if found >= end:
            raise FormatError(SECTION, name, f"below {end}", found)
        return found

    @abstractmethod
    def _code(self, value: int, probability: int) -> int:
        """One bit, of which a 1 has this probability in 65536ths."""


class Encoder(BinaryCoder):
    """Writes bits; `finish` gives the bytes."""

    encodes = True

    def __init__(self) -> None:
        super().__init__()
        self._low, self._range = 0, _FULL
        self._out = bytearray()

    def _code(self, value: int, probability: int) -> int:
        bound = self._range * (65536 - probability) >> 16
        if value:
            self._low += bound
            self._range -= bound
        else:
            self._range = bound
        while self._range < _TOP:
            self._shift()
        return value

    def _shift(self) -> None:
        self._carry()
        self._out.append(self._low >> 24)
        self._low = (self._low << 8) & _FULL
        self._range <<= 8

    def _carry(self) -> None:
        if self._low > _FULL:
            self._low &= _FULL
            place = len(self._out) - 1
            while self._out[place] == 255:
                self._out[place] = 0
                place -= 1
            self._out[place] += 1

    def finish(self) -> bytes:
        """All bytes but zeros among the last four, which a decoder takes for granted."""
        for kept in range(0, 33, 8):
            step = 1 << 32 - kept
            value = (self._low + step - 1) // step * step
            if value < self._low + self._range:
                break
        self._low = value
        self._carry()
        return bytes(self._out) + self._low.to_bytes(4, "big").rstrip(b"\0")


class Decoder(BinaryCoder):
    """Reads bits. Raises FormatError when it needs more than four bytes that are not there."""

    encodes = False

    def __init__(self, data: bytes | memoryview) -> None:
        super().__init__()
        self._data = bytes(data)
        self._at = 4
        self._code_, self._range = int.from_bytes(self._data[:4].ljust(4, b"\0"), "big"), _FULL

    def _code(self, value: int, probability: int) -> int:
        bound = self._range * (65536 - probability) >> 16
        bit = self._code_ >= bound
        if bit:
            self._code_ -= bound
            self._range -= bound
        else:
            self._range = bound
        while self._range < _TOP:
            self._range <<= 8
            self._code_ = self._code_ << 8 | self._byte()
        return int(bit)

    def _byte(self) -> int:
        at = self._at
        self._at += 1
        if at < len(self._data):
            return self._data[at]
        if at >= len(self._data) + 4:
            raise FormatError(SECTION, "bytes", "as many as the parts need", len(self._data))
        return 0

    def finish(self) -> None:
        """Raises FormatError when bytes other than zeros are left."""
        rest = self._data[self._at :]
        if rest.strip(b"\0"):
            raise FormatError(SECTION, "end", "zeros at most", f"{len(rest)} bytes")
