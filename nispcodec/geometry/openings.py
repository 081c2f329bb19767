"""Closing surfaces: where the signed distance closes an opening of the mesh, no surface is.

The winding number of a body with a hole passes 1/2 somewhere in the hole, and the zero set of any
field with that sign has a closing surface there. Points on them teach the chart network to tell
them from the asset, so that the decoder can leave them out.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.geometry.config import OpeningsConfig
from nispcodec.geometry.distance import DistanceField


def crossings(
    field: DistanceField, points: Float64Array, random: np.random.Generator, config: OpeningsConfig
) -> Float64Array:
    """Points (k, 3) on closing surfaces, looked for around points (n, 3), normalized frame.

    Each point takes one step in a random direction, shorter than its distance to the mesh, so that
    it cannot cross the mesh. Where the sign changes nevertheless, it crosses a closing surface.
    """
    direction = random.normal(size=points.shape)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    step = np.maximum(config.stride * field.closest(points, signed=False).sdf, 0.0)
    ends = points + direction * step[:, None]
    inside = field.inside(points)
    crossed = inside != field.inside(ends)
    found = _bisected(field, points[crossed], ends[crossed], inside[crossed], config.bisections)
    return found[field.closest(found, signed=False).sdf > config.clearance]


def spread_over(
    field: DistanceField,
    seeds: Float64Array,
    count: int,
    random: np.random.Generator,
    config: OpeningsConfig,
) -> Float64Array:
    """Up to `count` points (n, 3) on the closing surfaces that the seeds (k, 3) lie on.

    Normalized frame; the first points are the seeds.
    """
    found = [seeds]
    for _ in range(config.spreads):
        missing = count - sum(map(len, found))
        if missing <= 0:
            break
        known = np.concatenate(found)
        chosen = known[random.integers(len(known), size=config.children * missing)]
        away = field.closest(chosen, signed=False).sdf[:, None]
        moved = chosen + random.normal(size=chosen.shape) * 0.5 * np.maximum(away, 0.0)
        found.append(crossings(field, moved, random, config)[:missing])
    return np.concatenate(found)[:count]


def _bisected(
    field: DistanceField, start: Float64Array, end: Float64Array, inside: BoolArray, times: int
) -> Float64Array:
    for _ in range(times):
        middle = (start + end) / 2
        before = field.inside(middle) == inside
        start = np.where(before[:, None], middle, start)
        end = np.where(before[:, None], end, middle)
    return (start + end) / 2
