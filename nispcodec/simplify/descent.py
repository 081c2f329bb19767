"""The candidate that loses least, by whatever counts, found step by step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from nispcodec.core.mesh_part import MAX_GRID_BITS
from nispcodec.simplify.config import DescentConfig
from nispcodec.simplify.ladder import Candidate, Simplifier

Place = tuple[int, int, int]
"""Rungs below all faces, bits of positions, bits of UVs."""


def least_loss(
    simplifier: Simplifier,
    loss: Callable[[Candidate], float],
    config: DescentConfig,
) -> Candidate:
    """The candidate of the least loss of those looked at.

    Faces, bits of both kinds and bits of one are changed in turn, each for as long as that helps.
    Of candidates that lose the same, an infinite loss too, the one of the fewest bytes is best.
    """
    descent = _Descent(simplifier, loss, config)
    before = None
    while descent.best.place != before and descent.left:
        before = descent.best.place
        for step in config.steps:
            descent.follow(step)
    return descent.best.candidate


@dataclass(frozen=True)
class _Tried:
    place: Place
    candidate: Candidate
    loss: float

    def better_than(self, other: _Tried) -> bool:
        if self.loss == other.loss:
            return self.candidate.size < other.candidate.size
        return self.loss < other.loss


@dataclass
class _Descent:
    """What is best so far, and how many more may be tried."""

    simplifier: Simplifier
    loss: Callable[[Candidate], float]
    config: DescentConfig
    seen: set[Place] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.best = self._tried(self._first)

    @property
    def left(self) -> int:
        return self.config.trials - len(self.seen)

    def follow(self, step: Place) -> None:
        """Go on by a step, or back, for as long as that is better."""
        for sign in (1, -1):
            while self.left and self._moved(sign, step):
                pass

    def _moved(self, sign: int, step: Place) -> bool:
        rung, bits, uv_bits = (at + sign * by for at, by in zip(self.best.place, step, strict=True))
        least = self.config.least_bits
        place = min(max(rung, 0), self._last), _held(bits, least), _held(uv_bits, least)
        if place in self.seen:
            return False
        found = self._tried(place)
        better = found.better_than(self.best)
        if better:
            self.best = found
        return better

    def _tried(self, place: Place) -> _Tried:
        self.seen.add(place)
        rung, bits, uv_bits = place
        faces = round(self._all / self.config.growth**rung)
        candidate = self.simplifier.candidate(faces, bits, uv_bits)
        return _Tried(place, candidate, self.loss(candidate))

    @property
    def _first(self) -> Place:
        bits, uv_bits = self.config.first_bits
        return min(self._rungs(self.config.first_faces), self._last), bits, uv_bits

    @property
    def _last(self) -> int:
        return self._rungs(self.simplifier.config.fewest)

    @property
    def _all(self) -> int:
        return len(self.simplifier.source.triangles)

    def _rungs(self, faces: int) -> int:
        """Of all faces about so many are left this many rungs below."""
        return max(0, round(math.log(self._all / faces) / math.log(self.config.growth)))


def _held(bits: int, least: int) -> int:
    return min(max(bits, least), MAX_GRID_BITS)
