"""Planes across an axis, and what they make of points."""

from __future__ import annotations

from dataclasses import dataclass

from nispcodec.core.arrays import Float64Array
from nispcodec.core.mesh_part import Placement, Quaternion

# With x negated before, these turns negate x, y or z alone.
TURNS: tuple[Quaternion, ...] = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.0))


@dataclass(frozen=True)
class Mirror:
    """The plane where a coordinate is `at` (normalized frame)."""

    axis: int
    at: float

    def image(self, points: Float64Array) -> Float64Array:
        """Points (n, 3), reflected."""
        found = points.copy()
        found[:, self.axis] = 2 * self.at - found[:, self.axis]
        return found

    def placement(self, uv_scale: tuple[float, float], uv_offset: tuple[float, float]) -> Placement:
        """The placement of a half's reflection."""
        offset = [0.0, 0.0, 0.0]
        offset[self.axis] = 2 * self.at
        place = offset[0], offset[1], offset[2]
        return Placement(TURNS[self.axis], place, 1.0, True, uv_scale, uv_offset)


def planes_of(point: Float64Array) -> tuple[Mirror, ...]:
    """Planes across each axis, through the middle of the normalized frame and through a point."""
    places = {axis: dict.fromkeys((0.0, float(at))) for axis, at in enumerate(point)}
    return tuple(Mirror(axis, at) for axis, both in places.items() for at in both)
