"""The fewest bytes within errors, found in a few trials."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from nispcodec.core.mesh_part import MAX_GRID_BITS
from nispcodec.simplify.config import SearchConfig
from nispcodec.simplify.errors import Errors
from nispcodec.simplify.ladder import Candidate, Simplifier


@dataclass(frozen=True)
class Goal:
    """The mean distance (normalized frame) and mean UV error that are asked for."""

    distance: float
    uv: float

    def excess(self, errors: Errors) -> tuple[float, float]:
        """Logarithms of how many times too large both errors are; at most 0: good enough."""
        tiny = np.finfo(np.float64).tiny
        far, wrong = errors.distance / self.distance, errors.uv / self.uv
        return float(np.log(max(far, tiny))), float(np.log(max(wrong, tiny)))

    def held_by_uv(self, candidate: Candidate, uneven: float) -> bool:
        """Whether the UVs leave room in the distance: by this much, as a logarithm."""
        far, wrong = self.excess(candidate.errors)
        return wrong - far > uneven

    def met(self, candidate: Candidate) -> bool:
        """Whether both errors are small enough."""
        return candidate.errors.within(self.distance, self.uv)


def best_for(
    simplifier: Simplifier, distance: float, uv: float, config: SearchConfig = SearchConfig()
) -> Candidate | None:
    """The fewest bytes found whose mean distance and mean UV error are at most so large.

    None where not even all faces with the most bits are.
    """
    goal = Goal(distance, uv)
    bits, uv_bits = simplifier.bits_for(distance), simplifier.uv_bits_for(min(uv, config.uv_blur))
    found = _fewest_faces(simplifier, goal, bits, uv_bits, config)
    good = [] if found is None else [found]
    if found is not None and goal.held_by_uv(found[1], config.uneven):
        # Rounding moves seams: finer positions may do with fewer faces.
        finer = _fewest_faces(simplifier, goal, bits + 1, uv_bits, config, found[0])
        good += [] if finer is None else [finer]
    everything = len(simplifier.source.triangles)
    candidates = [_fewest_bits(simplifier, goal, *each, config) for each in good]
    if found is None or found[0] > config.nearly_all * everything:
        whole = kept_whole(simplifier, distance, uv, config)
        candidates += [] if whole is None else [whole]
    return min(candidates, key=lambda each: each.size, default=None)


def kept_whole(
    simplifier: Simplifier, distance: float, uv: float, config: SearchConfig = SearchConfig()
) -> Candidate | None:
    """All faces of the source with about the fewest bits whose rounding is within the errors.

    None where not even the most bits are.
    """
    everything, goal = len(simplifier.source.triangles), Goal(distance, uv)
    bits, uv_bits = (
        simplifier.bits_for(distance, whole=True),
        simplifier.uv_bits_for(min(uv, config.uv_blur)),
    )
    found = simplifier.candidate(everything, bits, uv_bits)
    while not goal.met(found):
        if max(bits, uv_bits) >= MAX_GRID_BITS:
            return None
        far, wrong = (excess > 0 for excess in goal.excess(found.errors))
        # Where faces lie on each other, rounding puts another one in front: with UVs of its own.
        finer = simplifier.candidate(everything, bits, uv_bits + 1) if wrong else found
        helps = finer.errors.uv < config.helping * found.errors.uv
        bits, uv_bits = bits + (far or not helps), uv_bits + (wrong and helps)
        found = simplifier.candidate(everything, bits, uv_bits)
    return _fewest_bits(simplifier, goal, everything, found, config)


def _fewest_faces(
    simplifier: Simplifier,
    goal: Goal,
    bits: int,
    uv_bits: int,
    config: SearchConfig,
    enough: int | None = None,
) -> tuple[int, Candidate] | None:
    """The fewest faces asked for that are good enough, and what came; all faces are not tried.

    enough: faces that fewer are sought than.
    """
    everything = len(simplifier.source.triangles)
    bracket = _Bracket(config, float(enough or everything))
    best: tuple[int, Candidate] | None = None
    wanted = bracket.first(config.first if enough is None else round(config.fewer * enough))
    for _ in range(config.trials):
        asked = round(float(np.exp(wanted)))
        if asked >= everything:
            break
        found = simplifier.candidate(asked, bits, uv_bits)
        if goal.met(found) and (best is None or asked < best[0]):
            best = asked, found
        bracket.add(wanted, goal.excess(found.errors))
        if bracket.closed:
            break
        wanted = bracket.next()
    return best


@dataclass
class _Bracket:
    """Logarithms of face counts: some too few, some enough; and what came of the last two."""

    config: SearchConfig
    everything: float
    low: float = 0.0
    high: float = 0.0
    closed: bool = False
    tried: list[tuple[float, tuple[float, float]]] = field(default_factory=list)

    def first(self, fewest: int) -> float:
        """The middle between few faces and all."""
        self.high = float(np.log(self.everything))
        return (min(float(np.log(fewest)), self.high) + self.high) / 2

    def add(self, wanted: float, excess: tuple[float, float]) -> None:
        """Narrow the bracket by what came."""
        self.tried.append((wanted, excess))
        worse = max(excess)
        if worse <= 0:
            self.high = min(self.high, wanted)
        else:
            self.low = max(self.low, wanted)
        near = -self.config.close <= worse <= 0
        self.closed = near or self.high - self.low < self.config.close

    def next(self) -> float:
        """Where the worse error should just be good enough; within the bracket."""
        aims = [self._aim(which) for which in (0, 1)]
        wanted = max(aims)
        if self.low < wanted < self.high:
            return wanted
        return (self.low + self.high) / 2

    def _aim(self, which: int) -> float:
        at, excess = self.tried[-1]
        slope = -1.0
        if len(self.tried) > 1:
            before, earlier = self.tried[-2]
            steep, flat = self.config.slopes
            found = (excess[which] - earlier[which]) / (at - before)
            slope = float(np.clip(found, -steep, -flat))
        # A little below the limit, so that what comes is good enough.
        return at - (excess[which] + self.config.close / 2) / slope


def _fewest_bits(
    simplifier: Simplifier, goal: Goal, faces: int, found: Candidate, config: SearchConfig
) -> Candidate:
    """Fewer bits for the same faces, as long as they are good enough, and UVs not blurred."""
    sharp = simplifier.uv_bits_for(config.uv_blur)
    while found.bits > 1:
        fewer = simplifier.candidate(faces, found.bits - 1, found.uv_bits)
        if not goal.met(fewer):
            break
        found = fewer
    while found.uv_bits > sharp:
        fewer = simplifier.candidate(faces, found.bits, found.uv_bits - 1)
        if not goal.met(fewer):
            break
        found = fewer
    return found
