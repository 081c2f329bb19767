"""Charts that lie over others in the texture: mirrored halves, wheels, planks.

Their nodes have coordinates that came before, beside others that came before.
"""

from __future__ import annotations

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.numbers import Context, signed

Pair = tuple[int, int]
MOST = 16
"""The most third corners that are kept of one edge in the texture, and neighbors of one place."""


class Stacking:
    """Coordinates in the order in which they came first, and which lie beside which.

    The three methods that ask say a hit with the coordinates, a miss or nothing to find with None.
    """

    def __init__(self, coder: BinaryCoder) -> None:
        self._coder = coder
        self._number: dict[Pair, int] = {}
        self._pairs: list[Pair] = []
        self._thirds: dict[tuple[Pair, Pair], list[Pair]] = {}
        self._beside: dict[Pair, dict[Pair, int]] = {}
        self._hits = 0

    def anywhere(self, wanted: Pair) -> Pair | None:
        """For a chart's first node: any that came before. Raises FormatError."""
        if not self._pairs:
            return None
        number = self._number.get(wanted)
        if not self._coder.bit(number is not None, slots.SEEN, 0, 0, 0):
            return None
        return self._pairs[self._coder.below(number or 0, len(self._pairs), "uv")]

    def beside(self, start: Pair, length: int, wanted: Pair) -> Pair | None:
        """For a chart's second node, so far from the first: one beside it. Raises FormatError."""
        known = self._beside.get(start, {})
        if not known or not self._coder.bit(wanted in known, slots.BESIDE, 0, 0, 0):
            return None
        ranked = sorted(known, key=lambda pair: (abs(known[pair] - length), pair))
        rank = ranked.index(wanted) if wanted in known else 0
        rank = signed(self._coder, rank, slots.RANK, Context(0))
        if not 0 <= rank < len(ranked):
            raise FormatError(SECTION, "uv_rank", f"0 to {len(ranked) - 1}", rank)
        return ranked[rank]

    def beyond(self, sides: list[tuple[Pair, Pair, Pair | None]], wanted: Pair) -> Pair | None:
        """For another node: the one that most faces had which lay over the same edges.

        sides: the ends of each edge, and what its own other face has there.
        """
        votes: dict[Pair, int] = {}
        for one, other, own in sides:
            for third in self._thirds.get(_edge(one, other), ()):
                if third != own:
                    votes[third] = votes.get(third, 0) + 1
        if not votes:
            return None
        best = max(votes, key=lambda pair: (votes[pair], pair))
        coder, sure = self._coder, min(votes[best], 3)
        hit = coder.bit(wanted == best, slots.STACKED, 0, self._hits, sure)
        self._hits = (self._hits << 1 | hit) & 7
        return best if hit else None

    def note(self, pair: Pair, edges: list[tuple[Pair, Pair]]) -> None:
        """Coordinates of a node, and of the edges that it has faces with."""
        if pair not in self._number:
            self._number[pair] = len(self._pairs)
            self._pairs.append(pair)
        for one, other in edges:
            for a, b, third in ((one, other, pair), (other, pair, one), (pair, one, other)):
                thirds = self._thirds.setdefault(_edge(a, b), [])
                if len(thirds) < MOST:
                    thirds.append(third)

    def join(self, one: Pair, other: Pair, length: int) -> None:
        """Coordinates at the two ends of an edge of so great a length in space."""
        for start, end in ((one, other), (other, one)):
            beside = self._beside.setdefault(start, {})
            if len(beside) < MOST:
                beside[end] = length


def _edge(one: Pair, other: Pair) -> tuple[Pair, Pair]:
    return (one, other) if one < other else (other, one)
