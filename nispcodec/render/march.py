"""Sphere tracing (Hart 1996) of a fitted field, which is a distance only nearly.

Steps are over-relaxed (Keinert et al. 2014; as much as the last steps suggest: Bálint and Valasek
2018), longer than the field allows, and taken back where two spheres in a row do not touch. Where a
ray has stepped through the surface, the crossing is found between its last two points.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nispcodec.decode.components import OUTSIDE
from nispcodec.decode.evaluate import evaluate
from nispcodec.decode.extract import LIMIT
from nispcodec.network import Network
from nispcodec.render.fragments import Floats, Indices, Integers
from nispcodec.render.space import Space

EPSILON = 1e-4
MAX_STEPS = 200
REFINEMENTS = 3
# Weight of the newest step in the trend of the field along a ray.
NEWEST = np.float32(0.5)
# Rays that leave this ball meet nothing any more.
BALL = OUTSIDE + 0.06
NUDGE = np.float32(1e-5)


@dataclass(frozen=True)
class Trace:
    """Of n rays: distance to the hit, infinite without (n,); evaluations (n,); given up (n,)."""

    distances: Floats
    steps: Integers
    lost: NDArray[np.bool_]


@dataclass(frozen=True)
class _Front:
    """Rays under way: their numbers; how far they are; the last step and the sphere before it; how
    fast the spheres grow along the ray, -1 when it meets the surface head-on.
    """

    number: Indices
    at: Floats
    step: Floats
    radius: Floats
    trend: Floats

    def __getitem__(self, chosen: NDArray[np.bool_]) -> _Front:
        return _Front(
            number=self.number[chosen],
            at=self.at[chosen],
            step=self.step[chosen],
            radius=self.radius[chosen],
            trend=self.trend[chosen],
        )


class March:
    """Rays (n, 3), (n, 3) through a field, from outside its surface or from `inside`."""

    def __init__(
        self,
        network: Network,
        space: Space,
        origins: Floats,
        directions: Floats,
        inside: bool = False,
    ) -> None:
        self._network, self._space = network, space
        self._origins, self._directions = origins, directions
        self._scale = np.float32((-1 if inside else 1) / space.slope)

    def run(self) -> Trace:
        """First crossings of the surface."""
        count = len(self._origins)
        distances = np.full(count, np.inf, np.float32)
        steps, lost = np.zeros(count, np.int32), np.zeros(count, np.bool_)
        front, leave = self._into_ball()
        for _ in range(MAX_STEPS):
            front = self._through_clear(front, leave)
            if len(front.number) == 0:
                break
            steps[front.number] += 1
            radius = self._radius(front.number, front.at)
            hit = radius < EPSILON
            distances[front.number[hit]] = self._crossing(front[hit], radius[hit])
            front = _stepped(front[~hit], radius[~hit])
        lost[front.number] = True
        return Trace(distances, steps, lost)

    def _into_ball(self) -> tuple[_Front, Floats]:
        """The rays that meet the ball, where they enter it, and where each ray leaves it (n,)."""
        along = -(self._origins * self._directions).sum(axis=1)
        nearest = (self._origins**2).sum(axis=1) - along**2
        half = np.sqrt(np.maximum(BALL**2 - nearest, 0)).astype(np.float32)
        leave = along + half
        number = np.flatnonzero((half > 0) & (leave > 0))
        still = np.zeros(len(number), np.float32)
        return _Front(number, np.maximum(along - half, 0)[number], still, still, still - 1), leave

    def _through_clear(self, front: _Front, leave: Floats) -> _Front:
        """The rays moved on to where the surface may be; those that have left are gone."""
        near = np.zeros(len(front.number), np.bool_)
        at, step, trend = front.at.copy(), front.step.copy(), front.trend.copy()
        moving = np.arange(len(at))
        while len(moving):
            number = front.number[moving]
            far = self._clear(number, at[moving])
            near[moving[far == 0]] = True
            moving, far = moving[far > 0], far[far > 0]
            at[moving] += far
            step[moving], trend[moving] = 0, -1
            moving = moving[at[moving] < leave[front.number[moving]]]
        return _Front(front.number, at, step, front.radius, trend)[near]

    def _clear(self, number: Indices, at: Floats) -> Floats:
        """How far the rays may go without asking the network: 0 where the surface may be."""
        place = (self._points(number, at) + np.float32(LIMIT)) / self._space.cell
        cell = np.clip(place.astype(np.int32), 0, len(self._space.clear) - 1)
        clear = self._space.clear[cell[:, 0], cell[:, 1], cell[:, 2]]
        # Beside cells that may hold surface there is nothing but the way to the cell's own border.
        tight = np.flatnonzero((clear > 0) & (clear < self._space.cell))
        towards = self._directions[number[tight]]
        towards = np.where(np.abs(towards) < NUDGE, NUDGE, towards)
        walls = (cell[tight] + (towards > 0) - place[tight]) / towards
        clear[tight] = np.maximum(clear[tight], walls.min(axis=1) * self._space.cell + NUDGE)
        return clear

    def _radius(self, number: Indices, at: Floats) -> Floats:
        """The sphere round each point that the surface cannot be in; negative beyond it."""
        return evaluate(self._network, self._points(number, at))[:, 0] * self._scale

    def _points(self, number: Indices, at: Floats) -> Floats:
        return self._origins[number] + at[:, None] * self._directions[number]

    def _crossing(self, front: _Front, radius: Floats) -> Floats:
        """Where the rays meet the surface: here, or within the step that went through it."""
        through = (radius < -EPSILON) & (front.step > 0)
        number, high, beyond = front.number[through], front.at[through], radius[through]
        low, before = high - front.step[through], front.radius[through]
        for _ in range(REFINEMENTS):
            # A share of the bracket stays on either side, so that it always shrinks.
            share = np.clip(before / (before - beyond), 0.05, 0.95)
            middle = low + share * (high - low)
            there = self._radius(number, middle)
            low, before = np.where(there > 0, (middle, there), (low, before))
            high, beyond = np.where(there > 0, (high, beyond), (middle, there))
        distances = front.at.copy()
        distances[through] = low + (high - low) * before / (before - beyond)
        return distances


def _stepped(front: _Front, radius: Floats) -> _Front:
    """One step on; back to the edge of the sphere before where the last step tore."""
    torn = front.step > front.radius + radius
    change = (radius - front.radius) / np.maximum(front.step, NUDGE)
    trend = np.where(front.step > 0, front.trend + NEWEST * (change - front.trend), front.trend)
    trend = np.where(torn, np.float32(-1), np.clip(trend, -1, 0.5))
    step = np.where(torn, front.radius, 2 / (1 - trend) * radius)
    at = front.at + np.where(torn, front.radius - front.step, step)
    return _Front(front.number, at, step, np.where(torn, front.radius, radius), trend)
