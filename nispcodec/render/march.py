"""Sphere tracing (Hart 1996) of a fitted field, which is a distance only nearly.

Steps are over-relaxed (Keinert et al. 2014; as much as the last steps suggest: Bálint and Valasek
2018), longer than the field allows, and taken back where two spheres in a row do not touch. Where a
ray has stepped through the surface, the crossing is found between its last two points.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.isosurface import BALL
from nispcodec.infer.evaluate import evaluate
from nispcodec.render.space import Space

EPSILON = 1e-4
# A ray that grazes the surface goes on by so much at least: nothing that a field holds is thinner.
LEAST_STEP = np.float32(5e-4)
# Where less than this is known to be free, the network is asked.
SHORTEST = np.float32(5e-4)
MAX_STEPS = 1000
REFINEMENTS = 3
# Weight of the newest step in the trend of the field along a ray.
NEWEST = np.float32(0.3)
# Rays that leave this ball meet nothing any more.
TRACED_BALL = BALL + 0.06


@dataclass(frozen=True)
class Trace:
    """The result of marching n rays.

    distances  (n,) float32 to the hit along each ray, infinite without one
    steps      (n,) int32: how often the network was evaluated
    lost       (n,) bool: rays that were given up
    """

    distances: Float32Array
    steps: Int32Array
    lost: BoolArray


@dataclass(frozen=True)
class _Front:
    """Rays under way: their numbers; how far they are; the last step and the sphere before it; how
    fast the spheres grow along the ray, -1 when it meets the surface head-on.
    """

    number: Int64Array
    at: Float32Array
    step: Float32Array
    radius: Float32Array
    trend: Float32Array

    def __getitem__(self, chosen: Int64Array) -> _Front:
        return _Front(*(getattr(self, field.name).take(chosen) for field in fields(self)))


class March:
    """Rays through a field, from outside its surface or from `inside`.

    Origins (n, 3) and unit directions (n, 3) are in the normalized frame; `space` is that of the
    network.
    """

    def __init__(
        self,
        network: Network,
        space: Space,
        origins: Float32Array,
        directions: Float32Array,
        inside: bool = False,
    ) -> None:
        self._network, self._space = network, space
        self._origins, self._directions = (
            np.ascontiguousarray(each.T) for each in (origins, directions)
        )
        self._side = np.float32(-1 if inside else 1)
        self._steps = np.zeros(len(origins), np.int32)

    def run(self) -> Trace:
        """March until all rays have crossed the surface, left the ball or taken MAX_STEPS."""
        found: list[tuple[_Front, Float32Array]] = []
        lost = np.zeros(len(self._steps), np.bool_)
        front, leave = self._into_ball()
        for _ in range(MAX_STEPS):
            radius = self._sphere(front.number, front.at)
            torn = _torn(front, radius)
            hit = _met(front, radius) & ~torn
            some = np.flatnonzero(hit)
            found.append((front[some], radius.take(some)))
            front = _within(_stepped(front, radius, torn), leave, ~hit)
            if len(front.number) == 0:
                break
        lost[front.number] = True
        return Trace(self._crossings(found), self._steps, lost)

    def _into_ball(self) -> tuple[_Front, Float32Array]:
        """The rays that meet the ball, where they enter it, and where each ray leaves it (n,)."""
        along = -(self._origins * self._directions).sum(axis=0)
        nearest = (self._origins**2).sum(axis=0) - along**2
        half = np.sqrt(np.maximum(TRACED_BALL**2 - nearest, 0)).astype(np.float32)
        leave = along + half
        number = np.flatnonzero((half > 0) & (leave > 0))
        still = np.zeros(len(number), np.float32)
        return _Front(number, np.maximum(along - half, 0)[number], still, still, still - 1), leave

    def _sphere(self, number: Int64Array, at: Float32Array) -> Float32Array:
        """Radii in which there is no surface round points of the rays; negative beyond it."""
        points = self._points(number, at)
        radius = self._space.free(points) * self._side
        asked = np.flatnonzero(np.abs(radius) < SHORTEST)
        self._steps[number.take(asked)] += 1
        radius[asked] = self._field(points[asked])
        return radius

    def _field(self, points: Float32Array) -> Float32Array:
        return evaluate(self._network, points)[:, 0] * (self._side / np.float32(self._space.slope))

    def _points(self, number: Int64Array, at: Float32Array) -> Float32Array:
        return (self._origins.take(number, axis=1) + at * self._directions.take(number, axis=1)).T

    def _crossings(self, found: list[tuple[_Front, Float32Array]]) -> Float32Array:
        """Where the rays (n,) meet the surface: on their last point or in the step to it."""
        front = _Front(
            *(np.concatenate([getattr(each, f.name) for each, _ in found]) for f in fields(_Front))
        )
        radius = np.concatenate([each for _, each in found])
        through = np.flatnonzero((radius < -EPSILON) & (front.step > 0))
        distances = np.full(len(self._steps), np.inf, np.float32)
        distances[front.number] = front.at
        distances[front.number.take(through)] = self._bracketed(
            front[through], radius.take(through)
        )
        return distances

    def _bracketed(self, front: _Front, beyond: Float32Array) -> Float32Array:
        """The surface between the last two points of rays, the spheres `beyond` it negative."""
        high, low, before = front.at, front.at - front.step, front.radius
        for _ in range(REFINEMENTS):
            # A share of the bracket stays on either side, so that it always shrinks.
            share = np.clip(before / (before - beyond), 0.05, 0.95)
            middle = low + share * (high - low)
            there = self._field(self._points(front.number, middle))
            low, before = np.where(there > 0, (middle, there), (low, before))
            high, beyond = np.where(there > 0, (high, beyond), (middle, there))
        crossing: Float32Array = low + (high - low) * before / (before - beyond)
        return crossing


def _within(front: _Front, leave: Float32Array, going: BoolArray) -> _Front:
    """Rays still `going` whose last sphere ends before they leave, steps no longer than to there.

    An over-relaxed step that ends beyond may have torn; only a point that is asked can tell.
    """
    start, end = front.at - front.step, leave.take(front.number)
    step = np.minimum(front.step, end - start)
    going &= start + front.radius < end
    return replace(front, at=start + step, step=step)[np.flatnonzero(going)]


def _torn(front: _Front, radius: Float32Array) -> BoolArray:
    """Whether the spheres at both ends of the last step leave a gap between them."""
    torn: BoolArray = front.step > (
        np.maximum(front.radius, LEAST_STEP) + np.maximum(np.abs(radius), LEAST_STEP)
    )
    return torn


def _met(front: _Front, radius: Float32Array) -> BoolArray:
    """Whether rays are through the surface, or as good as there and still nearing it.

    Those that graze it are not: they might make outlines fatter.
    """
    nearing = (front.radius - radius) / np.maximum(front.step, LEAST_STEP)
    met: BoolArray = radius < np.minimum(EPSILON, np.maximum(nearing * LEAST_STEP, 0))
    return met


def _stepped(front: _Front, radius: Float32Array, torn: BoolArray) -> _Front:
    """One step on; back to the edge of the sphere before where the last step tore."""
    before, here = np.maximum(front.radius, LEAST_STEP), np.maximum(radius, LEAST_STEP)
    change = (radius - front.radius) / np.maximum(front.step, LEAST_STEP)
    trend = np.where(front.step > 0, front.trend + NEWEST * (change - front.trend), front.trend)
    trend = np.where(torn, np.float32(-1), np.clip(trend, -1, 0.5))
    step = np.where(torn, before, 2 / (1 - trend) * here)
    at = front.at + np.where(torn, before - front.step, step)
    return _Front(front.number, at, step, np.where(torn, front.radius, radius), trend)
