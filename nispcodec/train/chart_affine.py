"""The affine map nearest to the UVs of each chart: what a chart-affine network starts from."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, IntArray


def affine_maps(
    coordinates: Float64Array, charts: IntArray, uvs: Float64Array, count: int, ridge: float
) -> tuple[Float32Array, Float32Array]:
    """Least squares for each of `count` charts, zeros for those without points.

    coordinates (n, d) as the network sees the points, charts (n,), uvs (n, 2) -> slopes
    (count, 2 d), those of u first, and offsets (count, 2). `ridge` is a variance below which a
    direction decides nothing: across a flat chart the samples hardly vary.
    """
    order = np.argsort(charts, kind="stable")
    bounds = np.searchsorted(charts[order], np.arange(count + 1))
    slopes = np.zeros((count, 2, coordinates.shape[1]))
    offsets = np.zeros((count, 2))
    for chart in np.flatnonzero(np.diff(bounds)):
        rows = order[bounds[chart] : bounds[chart + 1]]
        points, targets = coordinates[rows], uvs[rows]
        middle, target = points.mean(axis=0), targets.mean(axis=0)
        away = points - middle
        spread = away.T @ away / len(rows) + ridge * np.eye(away.shape[1])
        slopes[chart] = np.linalg.solve(spread, away.T @ (targets - target) / len(rows)).T
        offsets[chart] = target - slopes[chart] @ middle
    return slopes.reshape(count, -1).astype(np.float32), offsets.astype(np.float32)
