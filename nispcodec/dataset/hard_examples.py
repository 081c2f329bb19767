"""Hard examples: samples that a signed field puts on the wrong side, and what that costs.

A thin part that the field misses hardly shows in a mean error of the field: it is a few samples,
each off by less than the part is thick. What it costs the surface is the distance to what is left.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import Float32Array


def error_radii(
    points: Float32Array,
    sdf: Float32Array,
    field: Float32Array,
    limit: float,
    floaters: bool = False,
) -> Float32Array:
    """Error radii (n,) float32 of samples: 0 where `field` has the sign of `sdf`.

    points (n, 3), their distances sdf (n,) and those that a network gives, field (n,), normalized
    frame. For a sample on the wrong side it is the distance to the nearest sample that the field
    puts on the side where the former belongs, sought no further away than `limit`. With `floaters`,
    samples on the wrong side that are further than `limit` from the asset have |sdf|: so far off is
    a body or hollow that the asset has not. Early in a fit there are so many of these that all else
    would be neglected.
    """
    found = np.zeros(len(points), dtype=np.float32)
    for inside in (False, True):
        kept = (field < 0) == inside
        missed = ~kept & ((sdf < 0) == inside)
        found[missed] = _to_nearest(points[kept], points[missed], limit)
    far = (found > 0) & (np.abs(sdf) > limit) & floaters
    found[far] = np.abs(sdf[far])
    return found


def _to_nearest(known: Float32Array, points: Float32Array, limit: float) -> Float32Array:
    """Distances (n,) of points to the nearest known one, `limit` if there is none so near."""
    if not len(known) or not len(points):
        return np.full(len(points), limit, dtype=np.float32)
    tree = cKDTree(known, balanced_tree=False, compact_nodes=False)  # asked once: quick to build
    distance, _ = tree.query(points, distance_upper_bound=limit)
    return np.minimum(distance, limit).astype(np.float32)
