"""Membranes: where the signed distance closes an opening of the mesh, no surface is.

The winding number of a body with a hole passes 1/2 somewhere in the hole, and the zero set of any
field with that sign has a membrane there. Points on membranes teach the chart network to tell them
from the surface, so that the decoder can leave them out.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.geometry.distance import DistanceField

OPEN = 6e-3
"""A membrane nearer to the surface than this (normalized frame) closes no opening to speak of."""

REACH = 0.9
BISECTIONS = 6
SPREADS = 12
CHILDREN = 2


def crossings(
    field: DistanceField, points: Float64Array, random: np.random.Generator
) -> Float64Array:
    """Points (k, 3) on membranes, looked for around points (n, 3), normalized frame.

    A step shorter than the distance to the surface cannot cross it; where the sign changes on such
    a step nevertheless, it crosses a membrane.
    """
    direction = random.normal(size=points.shape)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    reach = np.maximum(REACH * field.closest(points, signed=False).sdf, 0.0)
    ends = points + direction * reach[:, None]
    inside = field.inside(points)
    crossed = inside != field.inside(ends)
    found = _bisected(field, points[crossed], ends[crossed], inside[crossed])
    return found[field.closest(found, signed=False).sdf > OPEN]


def spread_over(
    field: DistanceField, seeds: Float64Array, count: int, random: np.random.Generator
) -> Float64Array:
    """About `count` points (n, 3) on the membranes that the seeds (k, 3) lie on."""
    found = [seeds]
    for _ in range(SPREADS):
        missing = count - sum(map(len, found))
        if missing <= 0:
            break
        known = np.concatenate(found)
        chosen = known[random.integers(len(known), size=CHILDREN * missing)]
        away = field.closest(chosen, signed=False).sdf[:, None]
        moved = chosen + random.normal(size=chosen.shape) * 0.5 * np.maximum(away, 0.0)
        found.append(crossings(field, moved, random)[:missing])
    return np.concatenate(found)[:count]


def _bisected(
    field: DistanceField, start: Float64Array, end: Float64Array, inside: BoolArray
) -> Float64Array:
    for _ in range(BISECTIONS):
        middle = (start + end) / 2
        before = field.inside(middle) == inside
        start = np.where(before[:, None], middle, start)
        end = np.where(before[:, None], end, middle)
    return (start + end) / 2
