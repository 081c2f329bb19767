"""Positions, less what the faces beside them predict."""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import signed
from nispcodec.format.mesh.order import Hinges, visits

Vector = tuple[int, int, int]
ORIGIN = (0, 0, 0)
REACH = (13, 11, 11)
"""How far beyond its edge a face goes, in 16ths of the face before: by one, two, more faces."""


class _Positions:
    """Positions that are known."""

    def __init__(self, coder: BinaryCoder, count: int, bits: int) -> None:
        self._coder, self._bits = coder, bits
        self._top = (1 << bits) - 1
        self._last = -1
        self.found: list[Vector] = [ORIGIN] * count

    def code(self, vertex: int, hinges: Hinges, near: int, wanted: Vector) -> None:
        """The position of one vertex."""
        if hinges:
            expected = self._continued(hinges)
            size = sum(self._length(a, b) for a, b, _ in hinges) // len(hinges)
            sources = min(len(hinges), 3)
        else:
            source = near if near >= 0 else self._last
            middle = self._top >> 1
            expected = self.found[source] if source >= 0 else (middle, middle, middle)
            size = 1 << self._bits + (near < 0)
            sources = 4 if near >= 0 else 5
        self.found[vertex] = self._code(wanted, expected, size, sources)
        self._last = vertex

    def _length(self, a: int, b: int) -> int:
        (ax, ay, az), (bx, by, bz) = self.found[a], self.found[b]
        return abs(ax - bx) + abs(ay - by) + abs(az - bz)

    def _continued(self, hinges: Hinges) -> Vector:
        """The mean of where the faces beyond would go on to; without any, of the edges' middles."""
        found = self.found
        full = [hinge for hinge in hinges if hinge[2] >= 0]
        used = full or hinges
        reach = REACH[min(len(full), len(REACH)) - 1] if full else 0
        expected = []
        for axis in range(3):
            ends = sum(found[a][axis] + found[b][axis] for a, b, _ in used)
            beyond = sum(found[c][axis] for _, _, c in full)
            expected.append(
                ((16 + reach) * ends - 2 * reach * beyond + 16 * len(used)) // (32 * len(used))
            )
        return expected[0], expected[1], expected[2]

    def _code(self, wanted: Vector, expected: Vector, size: int, sources: int) -> Vector:
        length, fine = context_of_size(size)
        slot = slots.POSITION_START if sources > 3 else slots.POSITION
        before = 0
        made = []
        for axis in range(3):
            guess = min(max(expected[axis], 0), self._top)
            special = (before * 6 + sources) * 3 + axis
            rest = signed(
                self._coder, wanted[axis] - guess, slot, length, fine * 6 + sources, special
            )
            if not 0 <= guess + rest <= self._top:
                raise FormatError(SECTION, "position", f"0 to {self._top}", guess + rest)
            made.append(guess + rest)
            before = max(before, min(max(abs(rest).bit_length() - length, -3), 3) + 4)
        return made[0], made[1], made[2]


def code(
    coder: BinaryCoder,
    corners: list[int],
    twin: list[int],
    count: int,
    bits: int,
    given: list[Vector] | None,
) -> list[Vector]:
    """The positions of all `count` vertices, of `bits` bits a coordinate. Raises FormatError.

    corners, twin: the surface, (3 m).
    """
    positions = _Positions(coder, count, bits)
    for vertex, hinges, near in visits(corners, twin, [False] * count):
        positions.code(vertex, hinges, near, given[vertex] if given is not None else ORIGIN)
    return positions.found


def context_of_size(size: int) -> tuple[int, int]:
    """How many bits a rest should have beside edges of this size, and the size in half octaves."""
    octaves = size.bit_length()
    upper = size >> octaves - 2 & 1 if octaves > 1 else 0
    return (size >> 3).bit_length(), 2 * octaves + upper
