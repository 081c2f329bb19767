"""How the faces of a surface hang together: a border that grows over it, face by face.

What is known is bounded by loops of gates; a gate is a side of a known face whose other face is to
come, and runs as that face's side will. A face over the gate from u to w has a third point: a new
one, or one on a loop, mostly the one beside the gate (Gumhold and Strasser, "Real Time Compression
of Triangle Mesh Connectivity", 1998). The next gate is the one at the point with most faces: it is
closed before the border goes on, and so hardly ever runs into itself.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import Context, signed

GONE, OPEN, DEAD = 0, 1, 2
NEAR = 255
BUCKETS = 16


@dataclass
class Surface:
    """Faces in the order of the file.

    corners  (3 m) points, three a face
    twin     (3 m) the side that each side meets, -1 at borders
    points   how many points there are
    """

    corners: list[int] = field(default_factory=list)
    twin: list[int] = field(default_factory=list)
    points: int = 0


@dataclass
class Known:
    """The surface as its encoder knows it: sides (3 m) there, in their own order.

    twin   the side that each side meets
    fans   the point that each side starts at
    place  of each face its number in the file, -1 for those to come
    sides  of each side in the file the side that it is here
    """

    twin: list[int]
    fans: list[int]
    place: list[int]
    sides: list[int] = field(default_factory=list)
    starts: int = 0


class Growth:
    """The known part of one surface, its loops, and the coder that says what comes."""

    def __init__(self, coder: BinaryCoder, known: Known | None) -> None:
        self.surface = Surface()
        self._coder, self._known = coder, known
        self._start: list[int] = []
        self._next: list[int] = []
        self._previous: list[int] = []
        self._state: list[int] = []
        self._side: list[int] = []
        self._gate: dict[int, int] = {}
        self._gates_at: list[list[int]] = []
        self._place: list[int] = []
        self._degree: list[int] = []
        self._point_of: dict[int, int] = {}
        self._buckets: list[list[int]] = [[] for _ in range(BUCKETS)]
        self._history = 0

    def grow(self, faces: int) -> Surface:
        """All `faces` of the surface."""
        while len(self.surface.corners) < 3 * faces:
            gate = self._best()
            if gate is None:
                self._begin()
            else:
                self._grow(gate)
        return self.surface

    def _begin(self) -> None:
        """A component: its first face, and a loop of gates around it."""
        first = self._known_start()
        points = [self._point() for _ in range(3)]
        sides = self._add_face(points, first)
        gates = [self._add_gate(points[(i + 1) % 3], sides + i) for i in (0, 2, 1)]
        for gate, after in zip(gates, gates[1:] + gates[:1], strict=True):
            self._join(gate, after)
        for gate in gates:
            self._push(gate)

    def _known_start(self) -> int:
        known = self._known
        if known is None:
            return -1
        while known.place[known.starts] >= 0:
            known.starts += 1
        return 3 * known.starts

    def _point(self) -> int:
        self._degree.append(0)
        self._gates_at.append([])
        self.surface.points += 1
        return self.surface.points - 1

    def _add_face(self, points: list[int], side: int) -> int:
        """A face over its points; `side` is its first one as the encoder knows it."""
        at = len(self.surface.corners)
        self.surface.corners += points
        self.surface.twin += [-1, -1, -1]
        for point in points:
            self._degree[point] += 1
        known = self._known
        if known is not None:
            base, turn = side - side % 3, side % 3
            known.place[side // 3] = at // 3
            known.sides += [base + (turn + i) % 3 for i in range(3)]
            for i, point in enumerate(points):
                self._point_of[known.fans[base + (turn + i) % 3]] = point
        return at

    def _add_gate(self, start: int, side: int) -> int:
        gate = len(self._start)
        self._start.append(start)
        self._side.append(side)
        self._next.append(gate)
        self._previous.append(gate)
        self._state.append(OPEN)
        self._place.append(len(self._gates_at[start]))
        self._gates_at[start].append(gate)
        if self._known is not None:
            self._gate[side] = gate
        return gate

    def _join(self, gate: int, after: int) -> None:
        self._next[gate], self._previous[after] = after, gate

    def _push(self, gate: int) -> None:
        if self._state[gate] == OPEN:
            degree = self._degree
            ends = degree[self._start[gate]], degree[self._start[self._next[gate]]]
            self._buckets[min(max(ends), BUCKETS - 1)].append(gate)

    def _best(self) -> int | None:
        for bucket in reversed(self._buckets):
            while bucket:
                gate = bucket.pop()
                if self._state[gate] == OPEN:
                    return gate
        return None

    def _grow(self, gate: int) -> None:
        """The face over one gate, or that there is none."""
        face = self._known_face(gate)
        action, third = self._known_action(gate, face)
        action = self._code_action(gate, action)
        if action == slots.BORDER:
            self._state[gate] = DEAD
            return
        self._history = (self._history << 2 | (action - slots.NEW)) & 255
        if action == slots.NEW:
            self._insert(gate, self._point(), None, face)
            return
        third = self._third(gate, action, third)
        point = self._start[third]
        if point in (self._start[gate], self._start[self._next[gate]]):
            raise FormatError(SECTION, "third_point", "another than the gate's", point)
        left, right = self._insert(gate, point, third, face)
        if action == slots.RIGHT:
            self._close(right, self._next[right])
            self._code_pair(left)
        elif action == slots.LEFT:
            self._close(left, self._next[left])
            self._code_pair(right)

    def _third(self, gate: int, action: int, third: int) -> int:
        if action == slots.RIGHT:
            return self._next[self._next[gate]]
        return self._previous[gate] if action == slots.LEFT else self._code_split(gate, third)

    def _known_face(self, gate: int) -> int:
        """The side, as the encoder knows it, of the face to come that lies at the gate."""
        known = self._known
        return known.twin[known.sides[self._side[gate]]] if known is not None else -1

    def _known_action(self, gate: int, side: int) -> tuple[int, int]:
        known = self._known
        if known is None:
            return -1, -1
        if side < 0 or known.place[side // 3] >= 0:
            return slots.BORDER, -1
        base, turn = side - side % 3, side % 3
        right, left = base + (turn + 1) % 3, base + (turn + 2) % 3
        if known.fans[left] not in self._point_of:
            return slots.NEW, -1
        after, before = self._next[gate], self._previous[gate]
        if self._meets(known, right, after):
            return slots.RIGHT, -1
        if self._meets(known, left, before):
            return slots.LEFT, -1
        return slots.SPLIT, self._known_third(known, left)

    def _meets(self, known: Known, side: int, gate: int) -> bool:
        """Whether a side of the face to come is the one at another gate."""
        return self._state[gate] == OPEN and known.twin[side] == known.sides[self._side[gate]]

    def _known_third(self, known: Known, left: int) -> int:
        """The gate of a loop at the place where the face to come has its third point."""
        side = left
        while (over := known.twin[side]) >= 0:
            if known.place[over // 3] >= 0:
                return self._gate_of(known, over)
            side = over - over % 3 + (over + 1) % 3
        side = left - left % 3 + (left + 2) % 3
        while (over := known.twin[side]) >= 0:
            if known.place[over // 3] >= 0:
                return self._next[self._gate_of(known, over)]
            side = over - over % 3 + (over + 2) % 3
        raise AssertionError("a point that is known has a known face in its fan")

    def _gate_of(self, known: Known, side: int) -> int:
        at = 3 * known.place[side // 3]
        place = next(i for i in range(at, at + 3) if known.sides[i] == side)
        return self._gate[place]

    def _code_action(self, gate: int, action: int) -> int:
        bit = self._coder.bit
        start, degree = self._start, self._degree
        after, before = self._next[gate], self._previous[gate]
        u, w = start[gate], start[after]
        beside = min(degree[u], 10), min(degree[w], 10)
        general = beside[0] * 11 + beside[1]
        medium = self._history
        alive = (self._state[after] == OPEN) * 2 + (self._state[before] == OPEN)
        far = min(degree[start[before]], 9), min(degree[start[self._next[after]]], 9)
        special = (min(sum(beside), 16) * 10 + far[0]) * 10 + far[1]
        special = special * 4 + alive
        if bit(action == slots.NEW, slots.NEW, general, medium, special):
            return slots.NEW
        if self._state[after] == OPEN and bit(
            action == slots.RIGHT, slots.RIGHT, general, medium, special
        ):
            return slots.RIGHT
        if self._state[before] == OPEN and bit(
            action == slots.LEFT, slots.LEFT, general, medium, special
        ):
            return slots.LEFT
        is_border = bit(action == slots.BORDER, slots.BORDER, alive, medium, special)
        return slots.BORDER if is_border else slots.SPLIT

    def _code_split(self, gate: int, third: int) -> int:
        """Which gate begins at the third point: so many on or back, or any one in the file."""
        coder = self._coder
        ahead, behind = self._steps(gate, third) if coder.encodes else (0, 0)
        steps = min(ahead, behind)
        if coder.bit(steps > NEAR, slots.FAR, 0, 0, 0):
            return self._far(third)
        back = coder.bit(behind < ahead, slots.BACK, 0, 0, 0)
        links = self._previous if back else self._next
        found = gate
        length = signed(coder, steps, slots.STEPS, Context(0))
        if not 0 < length <= NEAR:
            raise FormatError(SECTION, "steps", f"1 to {NEAR}", length)
        for _ in range(length):
            found = links[found]
        return found

    def _steps(self, gate: int, third: int) -> tuple[int, int]:
        ahead, behind = gate, gate
        for steps in range(NEAR + 1):
            if ahead == third:
                return steps, NEAR + 1
            if behind == third:
                return NEAR + 1, steps
            ahead, behind = self._next[ahead], self._previous[behind]
        return NEAR + 1, NEAR + 1

    def _far(self, third: int) -> int:
        coder, encodes = self._coder, self._coder.encodes
        point = coder.below(self._start[third] if encodes else 0, self.surface.points, "point")
        gates = self._gates_at[point]
        return gates[coder.below(self._place[third] if encodes else 0, len(gates), "gate")]

    def _insert(self, gate: int, point: int, third: int | None, face: int) -> tuple[int, int]:
        """A face over a gate; where its point is known, it is where the gate `third` begins.

        -> the gates of its other two sides, from u to the point, from there to w.
        """
        before, after = self._previous[gate], self._next[gate]
        u, w = self._start[gate], self._start[after]
        side = self._add_face([u, w, point], face)
        self._meet(side, self._side[gate])
        self._remove(gate)
        left, right = self._add_gate(u, side + 2), self._add_gate(point, side + 1)
        if third is None:
            self._join(left, right)
        else:
            self._join(self._previous[third], right)
            self._join(left, third)
        self._join(before, left)
        self._join(right, after)
        for each in (before, left, right, after):
            self._push(each)
        return left, right

    def _meet(self, side: int, other: int) -> None:
        self.surface.twin[side], self.surface.twin[other] = other, side

    def _remove(self, gate: int) -> None:
        """Where it was among the gates at its point the last of these is now: no other moves."""
        self._state[gate] = GONE
        gates, place = self._gates_at[self._start[gate]], self._place[gate]
        last = gates.pop()
        if last != gate:
            gates[place], self._place[last] = last, place

    def _close(self, gate: int, other: int) -> None:
        """Two gates of a loop of their own are one edge: the loop is gone."""
        self._meet(self._side[gate], self._side[other])
        self._remove(gate)
        self._remove(other)

    def _code_pair(self, gate: int) -> None:
        """Whether a gate and the next are one edge, where they are a loop of their own."""
        other = self._next[gate]
        if self._next[other] != gate or self._state[other] != OPEN:
            return
        known = self._known
        meets = known is not None and self._meets(known, known.sides[self._side[gate]], other)
        if self._coder.bit(meets, slots.PAIR, 0, 0, 0):
            self._close(gate, other)
