"""Positions, less what the faces beside them predict.

A vertex lies beyond the edges that it has faces with, about as far as the faces on their other
sides, and near the plane of these. So of its three coordinates that one comes last in which the
plane is least steep: it is predicted from the other two, and mostly small.
"""

from __future__ import annotations

from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import BinaryCoder
from nispcodec.format.mesh.numbers import Context, coordinate, over, quarter, shortened
from nispcodec.format.mesh.order import Hinges, visits

Vector = tuple[int, int, int]
ORIGIN = (0, 0, 0)
<<<<<<< HEAD
REACH = (10, 9, 8)
"""How far beyond its edge a face goes, in 16ths of the face before: by one, two, more faces."""
ENDS = (0, 7, 5)
"""How far it is drawn to the ends of the chain of edges, in 16ths."""
FINE = 10
=======
AXES = range(3)
USUAL = 4
NORMAL_BITS = 20
"""Products with differences of positions stay below 2^53."""

# In 16ths, for vertices with one, two, more faces: how far they are beyond their edges, as against
# the faces on the other side; how far they are drawn to the ends of these edges' chain.
BEYOND = (10, 9, 8)
DRAWN = (0, 7, 5)
>>>>>>> coder


class _Positions:
    """Positions that are known, and how rough the surface is there."""

    def __init__(self, coder: BinaryCoder, count: int, bits: int) -> None:
        self._coder, self._bits = coder, bits
        self._top = (1 << bits) - 1
        self._last = -1
<<<<<<< HEAD
        self._rough = [4] * count
        self._rought = [4] * count
=======
        self._along, self._across = [USUAL] * count, [USUAL] * count
>>>>>>> coder
        self.found: list[Vector] = [ORIGIN] * count

    def code(self, vertex: int, hinges: Hinges, near: int, wanted: Vector) -> None:
        """The position of one vertex."""
        if hinges:
<<<<<<< HEAD
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
=======
            self.found[vertex] = self._beside(vertex, hinges, wanted)
        else:
            self.found[vertex] = self._start(near, wanted)
        self._last = vertex

    def _start(self, near: int, wanted: Vector) -> Vector:
        """From a vertex of one of its faces, or the one before in the file."""
        source = near if near >= 0 else self._last
        middle = self._top >> 1
        expected = self.found[source] if source >= 0 else (middle, middle, middle)
        kind = int(near < 0)
        before = 0
        found = [0, 0, 0]
        for axis in AXES:
            context = Context(max(self._bits - 2 + kind, 0), kind, before * 2 + kind, axis)
            found[axis], longer = self._coordinate(
                wanted[axis], expected[axis], slots.POSITION_START, context
>>>>>>> coder
            )
            before = max(before, longer)
        return found[0], found[1], found[2]

    def _coordinate(
        self, wanted: int, expected: int, slot: int, context: Context
    ) -> tuple[int, int]:
        return coordinate(self._coder, wanted, expected, self._top, slot, context)

    def _beside(self, vertex: int, hinges: Hinges, wanted: Vector) -> Vector:
        """From the faces that it has with known vertices."""
        expected = self._expected(hinges)
        normal, folded = self._normal(hinges)
        scales = self._scales(hinges)
        along, across = self._roughness(hinges)
        sources = min(len(hinges), 3)
        steep = [abs(part) for part in normal]
        last = steep.index(max(steep))
        found = [0, 0, 0]
        longest = tilt = 0
        for axis in AXES:
            if axis != last:
                scale = scales[axis]
                medium = quarter(scale) * 16 + longest
                context = Context((scale >> 5).bit_length(), sources, medium, along)
                found[axis], longer = self._coordinate(
                    wanted[axis], expected[axis], slots.POSITION, context
                )
                tilt += normal[axis] * (found[axis] - expected[axis])
                longest = max(longest, longer)
        level = expected[last] - (over(tilt, normal[last]) if normal[last] else 0)
        scale = scales[last]
        medium = quarter(scale) * 16 + longest
        context = Context((scale >> 6).bit_length(), sources, medium, folded * 16 + across)
        found[last], longer = self._coordinate(wanted[last], level, slots.NORMAL, context)
        self._along[vertex], self._across[vertex] = longest, longer
        return found[0], found[1], found[2]

    def _roughness(self, hinges: Hinges) -> tuple[int, int]:
        ends = [vertex for a, b, _ in hinges for vertex in (a, b)]
        along = sum(self._along[vertex] for vertex in ends) // len(ends)
        return along, sum(self._across[vertex] for vertex in ends) // len(ends)

    def _scales(self, hinges: Hinges) -> list[int]:
        """For each axis how far the vertices beside spread, in quarters."""
        places = [self.found[vertex] for hinge in hinges for vertex in hinge if vertex >= 0]
        spreads = [max(axis) - min(axis) for axis in zip(*places, strict=True)]
        return [3 * spread + max(spreads) for spread in spreads]

    def _normal(self, hinges: Hinges) -> tuple[list[int], int]:
        """The normals of the faces beyond, added; and how little they agree, from 0 to 7."""
        total = [0, 0, 0]
        size = 0
        for a, b, c in hinges:
            if c >= 0:
                (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (self.found[v] for v in (a, b, c))
                x = (by - ay) * (cz - az) - (bz - az) * (cy - ay)
                y = (bz - az) * (cx - ax) - (bx - ax) * (cz - az)
                z = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
                total = [total[0] + x, total[1] + y, total[2] + z]
                size += abs(x) + abs(y) + abs(z)
        lost = size - sum(abs(part) for part in total)
        return shortened(total, NORMAL_BITS), min(8 * lost // size, 7) if size else 7

    def _expected(self, hinges: Hinges) -> Vector:
        """The middle of the edges, moved beyond them and to the ends of their chain."""
        found = self.found
        which = min(len(hinges), 3) - 1
        vertices = [vertex for a, b, _ in hinges for vertex in (a, b)]
        ends = [vertex for vertex in vertices if vertices.count(vertex) == 1]
        over_edges = [c for _, _, c in hinges if c >= 0]
        expected = []
        for axis in AXES:
            middle = over(16 * sum(found[v][axis] for v in vertices), len(vertices))
            moved = middle
            if over_edges:
                beyond = over(16 * sum(found[v][axis] for v in over_edges), len(over_edges))
                moved += over(BEYOND[which] * (middle - beyond), 16)
            if ends:
                outer = over(16 * sum(found[v][axis] for v in ends), len(ends))
                moved += over(DRAWN[which] * (outer - middle), 16)
            expected.append(moved + 8 >> 4)
        return expected[0], expected[1], expected[2]


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
<<<<<<< HEAD


def frac(scale):
    """Quarter octave"""
    n = scale.bit_length()
    return (scale << 2 >> n - 1) & 3 if n else 0


def context_of_size(size: int) -> tuple[int, int]:
    """How many bits a rest should have beside edges of this size, and the size in half octaves."""
    octaves = size.bit_length()
    upper = size >> octaves - 2 & 1 if octaves > 1 else 0
    return (size >> 3).bit_length(), 2 * octaves + upper
=======
>>>>>>> coder
