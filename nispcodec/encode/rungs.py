"""Candidates of more and more faces: each a fixed factor above the one before, each made once."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property

from nispcodec.simplify.ladder import Candidate, Simplifier

Cost = tuple[float, float]
"""What a candidate is judged by: the second only where the first is equal."""


@dataclass(frozen=True)
class Rungs:
    """The rungs of a simplifier's ladder, from rung 0 of the fewest faces to all faces.

    growth          of the faces from one rung to the next
    bytes_per_face  that candidates typically take: where a search begins
    slope           of the bytes by the distance, both as logarithms, where two rungs do not say it
    far_nearer      times nearer than asked from which on a rung says no more of where to look: all
                    faces are exact
    tries           rungs that an estimate makes at most
    """

    simplifier: Simplifier
    growth: float
    bytes_per_face: float
    slope: float
    far_nearer: float
    tries: int
    _made: dict[int, Candidate] = field(default_factory=dict)

    def at(self, faces: int) -> Candidate:
        """The candidate of about so many faces."""
        if faces not in self._made:
            self._made[faces] = self.simplifier.balanced(faces)
        return self._made[faces]

    @property
    def made(self) -> tuple[Candidate, ...]:
        """All that were made."""
        return tuple(self._made.values())

    @property
    def largest(self) -> Candidate:
        """The candidate of the most faces of those that were made."""
        return self._made[max(self._made)]

    def about(self, distance: float) -> Candidate:
        """The candidate of as many faces as should have a mean distance.

        By those made before, and rungs that are made until there are some on either side.
        """
        far, near = _sides(self._made, distance)
        while not far or not near:
            made = {self._nearest(faces): each for faces, each in self._made.items()}
            rung = self._next(made, distance)
            if rung in made:
                return self._made[max(far) if far else min(near)]
            self.at(self._faces[rung])
            far, near = _sides(self._made, distance)
        low, high = max(far), min(near)
        share = self._share(self._made[low], self._made[high], distance)
        return self.at(round(low * (high / low) ** share))

    def cheapest(self, cost: Callable[[Candidate], Cost], faces: float) -> Candidate:
        """The candidate of least cost, found from that of about so many faces on as it falls."""
        rung = self._nearest(faces)
        best = self.at(self._faces[rung])
        for step in (-1, 1):
            while 0 <= rung + step < len(self._faces):
                other = self.at(self._faces[rung + step])
                if cost(other) >= cost(best):
                    break
                best, rung = other, rung + step
        return best

    def rising(self, most_bytes: float, distance: float | None = None) -> Iterator[Candidate]:
        """More and more faces, up to the first candidate of so many bytes.

        Where a distance is given, none of fewer faces than one that is known to be farther off, and
        none that is foreseen to have too many bytes once it is reached.
        """
        wanted = math.inf if distance is None else distance
        far = (faces for faces, made in self._made.items() if made.errors.distance > wanted)
        least, before = max(far, default=0), 0
        for faces in (each for each in self._faces if each >= least):
            # Where fewer faces cannot be had than the last had, the next are to be more.
            if faces <= before and faces < self._faces[-1]:
                continue
            found = self.at(faces)
            yield found
            near = distance is not None and found.errors.distance <= distance
            if found.size * (self.growth if near else 1.0) >= most_bytes:
                return
            before = found.faces

    def bytes_at(self, distance: float, few: float, many: float) -> float:
        """About how many bytes a mean distance takes, most exactly between `few` and `many`.

        One candidate is enough where that takes far more than `many`. Else rungs are made until
        two that are neighbors have the distance between them, `tries` at most.
        """
        made: dict[int, Candidate] = {}
        rung = self._nearest(math.sqrt(few * many) / self.bytes_per_face)
        guess = math.inf
        while rung not in made and len(made) < self.tries:
            made[rung] = self.at(self._faces[rung])
            guess = self._law(made, distance)
            if guess > self.growth * many:
                break
            rung = self._next(made, distance)
        return guess

    def _next(self, made: dict[int, Candidate], distance: float) -> int:
        """The rung where the distance is to be expected: between those made, or beyond."""
        far, near = _sides(made, distance)
        if not far or not near:
            last = max(far) if far else min(near)
            steps = self.slope * _logarithm(made[last], distance) / math.log(self.growth)
            beyond = last + (max(1, round(steps)) if far else min(-1, round(steps)))
            return min(max(beyond, 0), len(self._faces) - 1)
        low, high = max(far), min(near)
        share = self._share(made[low], made[high], distance)
        return min(max(low + 1, round(low + share * (high - low))), max(high - 1, low))

    def _law(self, made: dict[int, Candidate], distance: float) -> float:
        """Bytes at a distance, on the power law through the rungs on either side of it."""
        far, near = _sides(made, distance)
        if far and near:
            return _between(made[max(far)], made[min(near)], distance, self.slope)
        return _beyond(made[max(far) if far else min(near)], distance, self.slope)

    def _share(self, far: Candidate, near: Candidate, distance: float) -> float:
        """How much of the way from one candidate to the other lies before a distance."""
        before = _logarithm(far, distance)
        after = min(-_logarithm(near, distance), math.log(self.far_nearer))
        return before / max(before + after, sys.float_info.epsilon)

    @cached_property
    def _faces(self) -> list[int]:
        everything = len(self.simplifier.source.triangles)
        fewest = min(self.simplifier.config.fewest, everything)
        count = 1 + math.ceil(math.log(everything / fewest) / math.log(self.growth) - 1e-9)
        return [min(everything, round(fewest * self.growth**number)) for number in range(count)]

    def _nearest(self, faces: float) -> int:
        """The rung of the most nearly so many faces."""
        rungs = self._faces
        return min(range(len(rungs)), key=lambda each: abs(math.log(rungs[each] / faces)))


def _sides(made: dict[int, Candidate], distance: float) -> tuple[list[int], list[int]]:
    """The rungs that are farther off than a distance, and those that are as near."""
    far = [each for each, found in made.items() if found.errors.distance > distance]
    return far, [each for each in made if each not in far]


def _logarithm(found: Candidate, distance: float) -> float:
    """Of a candidate's distance against another: above 0 where it is farther off."""
    least, most = sys.float_info.epsilon, 2.0  # nothing in the unit ball is farther apart
    return math.log(min(max(found.errors.distance, least), most) / distance)


def _beyond(found: Candidate, distance: float, slope: float) -> float:
    """Bytes at a distance, from one candidate and a slope."""
    return found.size * math.exp(slope * _logarithm(found, distance))


def _between(one: Candidate, other: Candidate, distance: float, slope: float) -> float:
    """Bytes at a distance, on the power law through two candidates."""
    nearer = _logarithm(one, distance) - _logarithm(other, distance)
    larger = math.log(other.size / one.size)
    return _beyond(other, distance, larger / nearer if larger * nearer > 0 else slope)
