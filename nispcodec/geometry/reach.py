"""How far from the surface its pieces tell what is inside.

The side of the closest piece on which a point lies is the side of the solid, as no surface is
between. Two things spoil that: gaps, where pieces are left out that are hidden in part, and rims,
around which the winding number has no jump but changes all the way.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.cores import cores


def shared_corners(pieces: Float64Array, hidden: BoolArray) -> Float64Array:
    """Corners (g, 3) of hidden pieces and others both: the surface has gaps beside them."""
    if not hidden.any():
        return np.zeros((0, 3))
    corners = pieces.reshape(-1, 3)
    ids, below = row_ids(corners), np.repeat(hidden, 3)
    on_hidden, on_shown = np.bincount(ids, below) > 0, np.bincount(ids, ~below) > 0
    place = np.zeros((len(on_hidden), 3))
    place[ids] = corners
    return place[on_hidden & on_shown]


def rim_points(corners: Float64Array, rim: Int64Array, step: float) -> Float64Array:
    """Points (r, 3) on the sides `rim` of faces, at most `step` apart along each."""
    first = corners.reshape(-1, 3)[rim]
    way = np.roll(corners, -1, axis=1).reshape(-1, 3)[rim] - first
    parts = np.ceil(np.linalg.norm(way, axis=1) / step).astype(np.int64) + 1
    side = np.repeat(np.arange(len(rim)), parts)
    number = np.arange(len(side)) - np.repeat(np.cumsum(parts) - parts, parts)
    return first[side] + way[side] * (number / parts[side])[:, None]


def reach_of(
    pieces: Float64Array, gaps: Float64Array, rim: Float64Array, margin: float
) -> Float64Array:
    """How far from pieces (p,) their sides can be told by them: to the nearest gap, half to a rim.

    A winding number changes smoothly around a rim, and does not jump at gaps.
    """
    center = pieces.mean(axis=1)
    size = np.linalg.norm(pieces - center[:, None], axis=2).max(axis=1, initial=0.0) + margin
    reach = np.full(len(pieces), np.inf)
    for points, share in ((gaps, 1.0), (rim, 0.5)):
        if len(points):
            away = cKDTree(points).query(center, workers=cores())[0]
            reach = np.minimum(reach, share * (away - size))
    return np.maximum(reach, 0.0)
