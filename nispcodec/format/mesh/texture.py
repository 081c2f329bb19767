"""Texture coordinates, less what the faces beside them predict from positions and coordinates."""

from __future__ import annotations

from math import isqrt
from typing import NamedTuple

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import signed
from nispcodec.format.mesh.order import Hinges, visits
from nispcodec.format.mesh.positions import Vector, context_of_size

Pair = tuple[int, int]
FINE = 10
"""Bits of a difference of positions: products of four stay below 2^53."""
STEEP = 4
"""How many times further than a face's third node one may lie that continues it."""


class Guess(NamedTuple):
    """Coordinates that one face expects of a node.

    u, v     the coordinates, without the part across the edge unless `whole`
    whole    whether the face over the edge said how coordinates go on across it
    across   otherwise, the part across it as in a map that keeps angles and sides
    """

    u: int
    v: int
    whole: bool
    across: Pair


class _Texture:
    """Coordinates that are known, of nodes at their places."""

    def __init__(self, coder: BinaryCoder, places: list[Vector], bits: int) -> None:
        self._coder, self._places, self._bits = coder, places, bits
        self._top = (1 << bits) - 1
        self._last = -1
        self._flip = 0
        self.found: list[Pair] = [(0, 0)] * len(places)

    def code(self, node: int, hinges: Hinges, near: int, wanted: Pair) -> None:
        """The coordinates of one node."""
        if hinges:
            guesses = [self._guess(node, *hinge) for hinge in hinges]
            whole = [guess for guess in guesses if guess.whole]
            expected = _mean(whole) if whole else self._turned(guesses, wanted)
            size = sum(self._length(a, b) for a, b, _ in hinges) // len(hinges)
            sources = min(len(whole), 3)
        else:
            source = near if near >= 0 else self._last
            expected = self.found[source] if source >= 0 else (self._top >> 1, self._top >> 1)
            size = 1 << self._bits >> (2 if near >= 0 else 1)
            sources = 4 if near >= 0 else 5
        self.found[node] = self._code(wanted, expected, size, sources)
        self._last = node

    def _length(self, a: int, b: int) -> int:
        (ua, va), (ub, vb) = self.found[a], self.found[b]
        return abs(ua - ub) + abs(va - vb)

    def _turned(self, guesses: list[Guess], wanted: Pair) -> Pair:
        """Without a face beyond: to either side of the edge, as the file says."""
        left, right = _mean(guesses, 1), _mean(guesses, -1)
        if left != right:
            flip = _distance(wanted, right) < _distance(wanted, left)
            self._flip = self._coder.bit(flip, slots.FLIP, 0, self._flip, 0)
        return right if self._flip else left

    def _guess(self, node: int, a: int, b: int, c: int) -> Guess:
        """What the face of node, a and b expects; c is the node beyond the edge a b, or -1."""
        origin = self._places[a]
        (ua, va), (ub, vb) = self.found[a], self.found[b]
        u, v = ub - ua, vb - va
        others = (b, node, c) if c >= 0 else (b, node, a)
        edge, here, beyond = _fine([_minus(self._places[each], origin) for each in others])
        square = _dot(edge, edge)
        if square == 0:
            return Guess(ua, va, False, (0, 0))
        part, height = _foot(edge, square, here)
        pu, pv = ua + _over(u * part, square), va + _over(v * part, square)
        if c >= 0:
            part, other = _foot(edge, square, beyond)
            if other * STEEP >= height and other:
                uc, vc = self.found[c]
                du = _over((_over(u * part, square) - uc + ua) * height, other)
                dv = _over((_over(v * part, square) - vc + va) * height, other)
                return Guess(pu + du, pv + dv, True, (0, 0))
        return Guess(pu, pv, False, (_over(-v * height, square), _over(u * height, square)))

    def _code(self, wanted: Pair, expected: Pair, size: int, sources: int) -> Pair:
        length, fine = context_of_size(size)
        slot = slots.UV_START if sources > 3 else slots.UV
        before = 0
        made = []
        for axis in range(2):
            guess = min(max(expected[axis], 0), self._top)
            special = (before * 6 + sources) * 2 + axis
            rest = signed(
                self._coder, wanted[axis] - guess, slot, length, fine * 6 + sources, special
            )
            if not 0 <= guess + rest <= self._top:
                raise FormatError(SECTION, "uv", f"0 to {self._top}", guess + rest)
            made.append(guess + rest)
            before = min(max(abs(rest).bit_length() - length, -3), 3) + 4
        return made[0], made[1]


def code(
    coder: BinaryCoder,
    corners: list[int],
    twin: list[int],
    places: list[Vector],
    bits: int,
    given: list[Pair] | None,
) -> list[Pair]:
    """The coordinates of all nodes, of `bits` bits each. Raises FormatError.

    corners, twin: the surface (3 m), cut at its seams; places: where each node stands.
    """
    texture = _Texture(coder, places, bits)
    for node, hinges, near in visits(corners, twin, [False] * len(places)):
        texture.code(node, hinges, near, given[node] if given is not None else (0, 0))
    return texture.found


def _mean(guesses: list[Guess], side: int = 0) -> Pair:
    u = sum(guess.u + side * guess.across[0] for guess in guesses)
    v = sum(guess.v + side * guess.across[1] for guess in guesses)
    return u // len(guesses), v // len(guesses)


def _distance(one: Pair, other: Pair) -> int:
    return abs(one[0] - other[0]) + abs(one[1] - other[1])


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


def _dot(one: Vector, other: Vector) -> int:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _fine(vectors: list[Vector]) -> list[Vector]:
    """All without as many of their last bits that FINE are left of the largest number."""
    longest = max(abs(number) for vector in vectors for number in vector).bit_length()
    shift = max(longest - FINE, 0)
    return [(x >> shift, y >> shift, z >> shift) for x, y, z in vectors]


def _foot(edge: Vector, square: int, point: Vector) -> tuple[int, int]:
    """Of a point, times the edge's length: its part along the edge, its height above it."""
    part = _dot(edge, point)
    return part, isqrt(max(square * _dot(point, point) - part * part, 0))


def _over(number: int, divisor: int) -> int:
    """The nearest integer to a quotient, of two the higher."""
    return (2 * number + divisor) // (2 * divisor)
