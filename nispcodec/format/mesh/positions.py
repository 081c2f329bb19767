"""Positions, less what the faces beside them predict."""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import signed
from nispcodec.format.mesh.order import Hinges, visits

Vector = tuple[int, int, int]
ORIGIN = (0, 0, 0)
REACH = (10, 9, 8)
"""How far beyond its edge a face goes, in 16ths of the face before: by one, two, more faces."""
ENDS = (0, 7, 5)
"""How far it is drawn to the ends of the chain of edges, in 16ths."""
FINE = 10


class _Positions:
    """Positions that are known."""

    def __init__(self, coder: BinaryCoder, count: int, bits: int) -> None:
        self._coder, self._bits = coder, bits
        self._top = (1 << bits) - 1
        self._last = -1
        self._rough = [4] * count
        self._rought = [4] * count
        self.found: list[Vector] = [ORIGIN] * count

    def code(self, vertex: int, hinges: Hinges, near: int, wanted: Vector) -> None:
        """The position of one vertex."""
        if hinges:
            self._beside(vertex, hinges, wanted)
        else:
            source = near if near >= 0 else self._last
            middle = self._top >> 1
            expected = self.found[source] if source >= 0 else (middle, middle, middle)
            size = 1 << self._bits + (near < 0)
            self.found[vertex] = self._code(wanted, expected, size, 4 if near >= 0 else 5)
        self._last = vertex

    def _beside(self, vertex: int, hinges: Hinges, wanted: Vector) -> None:
        full = [hinge for hinge in hinges if hinge[2] >= 0]
        expected = list(self._continued(hinges, full))
        normal, flat = self._normal(full)
        sources = min(len(hinges), 3)
        sizes = [abs(x) for x in normal]
        last = max(range(3), key=sizes.__getitem__)
        nodes = [self.found[v] for hinge in hinges for v in hinge if v >= 0]
        around = [v for a, b, _ in hinges for v in (a, b)]
        rough = sum(self._rough[v] for v in around) // len(around)
        rought = sum(self._rought[v] for v in around) // len(around)
        extents = [max(p[i] for p in nodes) - min(p[i] for p in nodes) for i in range(3)]
        widest = max(extents)
        made = [0, 0, 0]
        before = 0
        tilt = 0
        for axis in range(3):
            if axis == last:
                continue
            guess = min(max(expected[axis], 0), self._top)
            scale = 3 * extents[axis] + widest
            length, fine = (scale >> 5).bit_length(), frac(scale)
            share = min(4 * sizes[axis] // sizes[last], 3) if sizes[last] else 3
            rest = signed(
                self._coder,
                wanted[axis] - guess,
                slots.POSITION,
                length,
                sources,
                fine * 4 + sources,
                (before * 16 + rought) * 4 + sources,
            )
            made[axis] = guess + rest
            tilt += normal[axis] * (made[axis] - expected[axis])
            bits = min(max(abs(rest).bit_length() - length, -3), 3) + 4
            before = max(before, bits)
            self._rought[vertex] = before
        guess = expected[last] - (_over(tilt, normal[last]) if normal[last] else 0)
        guess = min(max(guess, 0), self._top)
        scale = 3 * extents[last] + widest
        length, fine = (scale >> 6).bit_length(), frac(scale)
        share = min(4 * (sum(sizes) - sizes[last]) // sizes[last], 7) if sizes[last] else 3
        rest = signed(
            self._coder,
            wanted[last] - guess,
            slots.NORMAL,
            length,
            sources,
            (flat * 4 + sources) * 8 + before,
            (sources * 16 + rough) * 8 + before,
        )
        made[last] = guess + rest
        self._rough[vertex] = min(max(abs(rest).bit_length() - length, -3), 6) + 4
        for axis in range(3):
            if not 0 <= made[axis] <= self._top:
                raise FormatError(SECTION, "position", f"0 to {self._top}", made[axis])
        self.found[vertex] = made[0], made[1], made[2]

    def _normal(self, full: Hinges) -> tuple[Vector, int]:
        total = [0, 0, 0]
        parts = 0
        for a, b, c in full:
            A, B, C = self.found[a], self.found[b], self.found[c]
            u = [B[i] - A[i] for i in range(3)]
            v = [C[i] - A[i] for i in range(3)]
            n = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
            parts += abs(n[0]) + abs(n[1]) + abs(n[2])
            for i in range(3):
                total[i] += n[i]
        size = sum(map(abs, total))
        return tuple(total), min(8 * (parts - size) // parts, 7) if parts else 7

    def _length(self, a: int, b: int) -> int:
        (ax, ay, az), (bx, by, bz) = self.found[a], self.found[b]
        return abs(ax - bx) + abs(ay - by) + abs(az - bz)

    def _continued(self, hinges: Hinges, full: Hinges) -> Vector:
        """The mean of where the faces beyond would go on to; without any, of the edges' middles."""
        found = self.found
        used = hinges
        which = min(len(hinges), len(REACH)) - 1
        reach, drawn = REACH[which], ENDS[which]
        counts: dict[int, int] = {}
        for a, b, _ in hinges:
            counts[a] = counts.get(a, 0) + 1
            counts[b] = counts.get(b, 0) + 1
        ends = [v for v, n in counts.items() if n == 1]
        expected = []
        for axis in range(3):
            middle = sum(found[a][axis] + found[b][axis] for a, b, _ in used)
            value = _over(16 * middle, 2 * len(used))
            value16 = value
            if full:
                beyond = sum(found[c][axis] for _, _, c in full)
                value16 += _over(reach * (value * len(full) - 16 * beyond), 16 * len(full))
            if ends:
                value16 += _over(
                    drawn * (16 * sum(found[v][axis] for v in ends) - value * len(ends)),
                    16 * len(ends),
                )
            expected.append((value16 + 8) >> 4)
        return expected[0], expected[1], expected[2]

    def _code(self, wanted: Vector, expected: Vector, size: int, sources: int) -> Vector:
        length, fine = context_of_size(size)
        before = 0
        made = []
        for axis in range(3):
            guess = min(max(expected[axis], 0), self._top)
            special = (before * 6 + sources) * 3 + axis
            rest = signed(
                self._coder,
                wanted[axis] - guess,
                slots.POSITION_START,
                length,
                sources,
                fine * 6 + sources,
                special,
            )
            if not 0 <= guess + rest <= self._top:
                raise FormatError(SECTION, "position", f"0 to {self._top}", guess + rest)
            made.append(guess + rest)
            before = max(before, min(max(abs(rest).bit_length() - length, -3), 3) + 4)
        return made[0], made[1], made[2]


def _over(number: int, divisor: int) -> int:
    return (2 * number + divisor) // (2 * divisor)


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


def frac(scale):
    """Quarter octave"""
    n = scale.bit_length()
    return (scale << 2 >> n - 1) & 3 if n else 0


def context_of_size(size: int) -> tuple[int, int]:
    """How many bits a rest should have beside edges of this size, and the size in half octaves."""
    octaves = size.bit_length()
    upper = size >> octaves - 2 & 1 if octaves > 1 else 0
    return (size >> 3).bit_length(), 2 * octaves + upper
