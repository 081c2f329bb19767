"""Where the frames of a UV network start: the affine map nearest to the UVs of each chart."""

from __future__ import annotations

import numpy as np

from nispcodec.mesh.sample_set import Floats, SampleSet
from nispcodec.network import NetworkSpec

RIDGE = 1e-4
"""Variance below which a direction decides nothing: across a flat chart the samples hardly vary."""


def affine_maps(spec: NetworkSpec, samples: SampleSet) -> tuple[Floats, Floats]:
    """Least squares for every chart: slopes (charts, 2 x coordinates) and offsets (charts, 2)."""
    coordinates = _coordinates(spec, samples.points).astype(np.float64)
    order = np.argsort(samples.chart, kind="stable")
    bounds = np.searchsorted(samples.chart[order], np.arange(spec.charts + 1))
    slopes = np.zeros((spec.charts, 2, spec.coordinates))
    offsets = np.zeros((spec.charts, 2))
    for chart in np.flatnonzero(np.diff(bounds)):
        rows = order[bounds[chart] : bounds[chart + 1]]
        points, uvs = coordinates[rows], samples.uv[rows].astype(np.float64)
        middle, target = points.mean(axis=0), uvs.mean(axis=0)
        away = points - middle
        spread = away.T @ away / len(rows) + RIDGE * np.eye(spec.coordinates)
        slopes[chart] = np.linalg.solve(spread, away.T @ (uvs - target) / len(rows)).T
        offsets[chart] = target - slopes[chart] @ middle
    return slopes.reshape(spec.charts, -1).astype(np.float32), offsets.astype(np.float32)


def _coordinates(spec: NetworkSpec, points: Floats) -> Floats:
    """As the network sees them: absolute values of mirrored axes, then those that follow."""
    folded = np.where(spec.mirrored, np.abs(points), points)
    return np.hstack([folded, points[:, list(spec.sided)]])
