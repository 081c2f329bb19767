"""Texture coordinates, less what the faces beside them predict from positions and coordinates."""

from __future__ import annotations

from math import isqrt
from typing import NamedTuple

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import (
    Context,
    clamp,
    coordinate,
    over,
    quarter,
    shortened,
    signed,
)
from nispcodec.format.mesh.order import Hinges, visits
from nispcodec.format.mesh.positions import Vector
from nispcodec.format.mesh.stacking import Pair, Stacking

FINE = 10
"""Bits of a difference of positions: products of four stay below 2^53."""
AWAY = 16
"""How many lengths of an edge a node may lie before or behind it, to be predicted from it."""
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
        self._stacking = Stacking(coder)
        # How long first edges of charts were in space and texture, the last ones most.
        self._far, self._wide = 1, 1
        self.found: list[Pair] = [(0, 0)] * len(places)

    def code(self, node: int, hinges: Hinges, near: int, wanted: Pair) -> None:
        """The coordinates of one node."""
        stacking, found = self._stacking, self.found
        if hinges:
            sides = [(found[a], found[b], found[c] if c >= 0 else None) for a, b, c in hinges]
            made = stacking.beyond(sides, wanted) or self._continued(node, hinges, wanted)
        elif near >= 0:
            length = self._distance(node, near)
            made = stacking.beside(found[near], length, wanted) or self._second(
                found[near], length, wanted
            )
        else:
            made = stacking.anywhere(wanted) or self._first(wanted)
        found[node] = made
        self._last = node
        stacking.note(made, [(found[a], found[b]) for a, b, _ in hinges])
        ends = {each for a, b, _ in hinges for each in (a, b)} or ({near} - {-1})
        for end in sorted(ends):
            stacking.join(made, found[end], self._distance(node, end))

    def _distance(self, one: int, other: int) -> int:
        edge = _minus(self._places[one], self._places[other])
        return isqrt(_dot(edge, edge))

    def _first(self, wanted: Pair) -> Pair:
        """The first of a chart: near the node before, if anywhere."""
        middle = self._top >> 1
        expected: Pair = self.found[self._last] if self._last >= 0 else (middle, middle)
        length = max(self._bits - 3, 0)
        return self._coordinates(wanted, expected, slots.UV_START, [length, length], [0, 0], [0, 0])

    def _second(self, start: Pair, length: int, wanted: Pair) -> Pair:
        """The second of a chart: as far from the first as edges of its length are elsewhere."""
        coder = self._coder
        size = min(self._wide * length // self._far, 4 << self._bits)
        context = Context(size.bit_length(), 0, quarter(size), 0)
        u, _ = coordinate(coder, wanted[0], start[0], self._top, slots.UV_SECOND, context)
        left = isqrt(max(size * size - (u - start[0]) ** 2, 0))
        down = coder.bit(wanted[1] < start[1], slots.DOWN, 0, 0, 0)
        slope = min(8 * left // (size + 1), 7)
        context = Context((size >> 3).bit_length(), 0, slope, quarter(size))
        rise = left + signed(coder, abs(wanted[1] - start[1]) - left, slots.UV_THIRD, context)
        v = start[1] + (-rise if down else rise)
        if not 0 <= v <= self._top:
            raise FormatError(SECTION, "uv", f"0 to {self._top}", v)
        if length:
            self._far += 16 * length - self._far // 4
            self._wide += 16 * isqrt((u - start[0]) ** 2 + rise * rise) - self._wide // 4
        return u, v

    def _continued(self, node: int, hinges: Hinges, wanted: Pair) -> Pair:
        """The coordinates of a node that has faces with known ones."""
        guesses = [self._guess(node, *hinge) for hinge in hinges]
        whole = [guess for guess in guesses if guess.whole]
        expected = _mean(whole) if whole else self._turned(guesses, wanted)
        used = whole or guesses
        around = [self.found[each] for hinge in hinges for each in hinge if each >= 0]
        spreads = [max(axis) - min(axis) for axis in zip(expected, *around, strict=True)]
        lengths, apart = [], []
        for axis in range(2):
            lengths.append((3 * spreads[axis] + max(spreads) >> 6).bit_length())
            values = [(guess.u, guess.v)[axis] for guess in used]
            differ = max(values) - min(values)
            apart.append(clamp(differ.bit_length() - lengths[axis] + 4, 0, 7))
        sources = [min(len(whole), 3)] * 2
        return self._coordinates(wanted, expected, slots.UV, lengths, sources, apart)

    def _coordinates(
        self,
        wanted: Pair,
        expected: Pair,
        slot: int,
        lengths: list[int],
        sources: list[int],
        apart: list[int],
    ) -> Pair:
        """Both, each with the length of its rest, and two contexts."""
        found = [0, 0]
        before = 0
        for axis in range(2):
            general, medium = sources[axis], apart[axis] * 4 + sources[axis]
            context = Context(lengths[axis], general, medium, before * 4 + general)
            found[axis], before = coordinate(
                self._coder, wanted[axis], expected[axis], self._top, slot, context
            )
        return found[0], found[1]

    def _turned(self, guesses: list[Guess], wanted: Pair) -> Pair:
        """Without a face beyond: to either side of the edge, as the file says."""
        left, right = _mean(guesses, 1), _mean(guesses, -1)
        if left != right:
            flip = _difference(wanted, right) < _difference(wanted, left)
            self._flip = self._coder.bit(flip, slots.FLIP, 0, self._flip, 0)
        return right if self._flip else left

    def _guess(self, node: int, a: int, b: int, c: int) -> Guess:
        """How the face of node, a and b goes on; c is the node beyond the edge a b, or -1."""
        origin = self._places[a]
        (ua, va), (ub, vb) = self.found[a], self.found[b]
        u, v = ub - ua, vb - va
        others = (b, node, c) if c >= 0 else (b, node, a)
        edge, here, beyond = _fine([_minus(self._places[each], origin) for each in others])
        square = _dot(edge, edge)
        part, height = _foot(edge, square, here)
        if abs(part) > AWAY * square or square == 0:
            return Guess(ua, va, False, (0, 0))
        pu, pv = ua + over(u * part, square), va + over(v * part, square)
        if c >= 0:
            part, other = _foot(edge, square, beyond)
            if other and other * STEEP >= height and abs(part) <= AWAY * square:
                uc, vc = self.found[c]
                du = over((over(u * part, square) - uc + ua) * height, other)
                dv = over((over(v * part, square) - vc + va) * height, other)
                return Guess(pu + du, pv + dv, True, (0, 0))
        return Guess(pu, pv, False, (over(-v * height, square), over(u * height, square)))


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


def _difference(one: Pair, other: Pair) -> int:
    return abs(one[0] - other[0]) + abs(one[1] - other[1])


def _minus(one: Vector, other: Vector) -> Vector:
    return one[0] - other[0], one[1] - other[1], one[2] - other[2]


def _dot(one: Vector, other: Vector) -> int:
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2]


def _fine(vectors: list[Vector]) -> list[Vector]:
    x = shortened([number for vector in vectors for number in vector], FINE)
    return [(x[0], x[1], x[2]), (x[3], x[4], x[5]), (x[6], x[7], x[8])]


def _foot(edge: Vector, square: int, point: Vector) -> tuple[int, int]:
    """A point's part along the edge and its height above it, times the edge's length."""
    part = _dot(edge, point)
    return part, isqrt(max(square * _dot(point, point) - part * part, 0))
