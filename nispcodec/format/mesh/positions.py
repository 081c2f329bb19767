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
AXES = range(3)
USUAL = 4
NORMAL_BITS = 20
"""Products with differences of positions stay below 2^53."""

# In 16ths, for vertices with one, two, more faces: how far they are beyond their edges, as against
# the faces on the other side; how far they are drawn to the ends of these edges' chain.
BEYOND = (10, 9, 8)
DRAWN = (0, 7, 5)


class _Positions:
    """Positions that are known, and how rough the surface is there."""

    def __init__(self, coder: BinaryCoder, count: int, bits: int) -> None:
        self._coder, self._bits = coder, bits
        self._top = (1 << bits) - 1
        self._last = -1
        self._along, self._across = [USUAL] * count, [USUAL] * count
        self.found: list[Vector] = [ORIGIN] * count

    def code(self, vertex: int, hinges: Hinges, near: int, wanted: Vector) -> None:
        """The position of one vertex."""
        if hinges:
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
