"""How often a model finds the chart of a point."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from nispcodec.core.arrays import Float64Array, FloatArray, IntArray

POINTS = 20_000
CLEARLY = 5e-3


class Chooser(Protocol):
    """A model that predicts charts and UVs, such as `nispcodec.model.NispModel`."""

    @property
    def chart_materials(self) -> IntArray:
        """The material (k,) of each chart."""

    def charts(self, points: Float64Array) -> IntArray:
        """The charts (n,) of world points (n, 3)."""

    def uv(self, points: Float64Array, *, charts: IntArray) -> FloatArray:
        """The UVs (n, 2) of world points (n, 3) on the charts (n,)."""


def chart_accuracy(
    model: Chooser, points: Float64Array, uvs: Float64Array, materials: IntArray
) -> float:
    """Share of points on the surface whose predicted chart is right.

    points (n, 3) in the world frame, the original's uvs (n, 2) and materials (n,) there. A model
    numbers charts as it likes: it may cut one, and give charts far apart the same number. So a
    prediction is right when its chart is of the point's material and none of the others gives a
    UV that is closer by more than `CLEARLY` of the atlas. The first POINTS points are judged.
    """
    points, uvs, materials = points[:POINTS], uvs[:POINTS], materials[:POINTS]
    predicted = model.charts(points)
    alike = model.chart_materials[predicted] == materials
    best = np.full(len(points), np.inf)
    for chart in range(len(model.chart_materials)):
        candidate = np.full(len(points), chart, dtype=np.int32)
        best = np.minimum(best, _error(model, points, uvs, candidate))
    slack = CLEARLY * np.linalg.norm(np.ptp(uvs, axis=0))
    near = _error(model, points, uvs, predicted) <= best + slack
    return float((alike & near).mean())


def _error(
    model: Chooser, points: Float64Array, uvs: Float64Array, charts: IntArray
) -> Float64Array:
    found = model.uv(points, charts=charts)
    error: Float64Array = np.linalg.norm(found - uvs, axis=1)
    return error
