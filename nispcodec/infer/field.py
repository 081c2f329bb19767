"""Queries on a field: distance, normal, chart, UV, the surface; all in the normalized frame."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Int32Array, IntArray
from nispcodec.core.document import Field
from nispcodec.infer.evaluate import classify, evaluate, gradient

PROJECTION_STEPS = 8


class FieldQueries:
    """The networks of a field, to be asked at points (n, 3) float32."""

    def __init__(self, field: Field) -> None:
        self._field = field

    @property
    def chart_count(self) -> int:
        """How many charts it numbers, openings included."""
        return len(self._field.charts)

    def sdf(self, points: Float32Array) -> Float32Array:
        """Signed distance to the surface (n,)."""
        values: Float32Array = evaluate(self._field.sdf, points)[:, 0]
        return values

    def normals(self, points: Float32Array) -> Float32Array:
        """Unit gradient of the SDF (n, 3), 0 where it is flat."""
        _, slopes = gradient(self._field.sdf, points)
        lengths = np.linalg.norm(slopes, axis=1, keepdims=True)
        units = np.zeros_like(slopes)
        np.divide(slopes, lengths, out=units, where=lengths > 0)
        return units

    def charts(self, points: Float32Array, seen: bool = False) -> Int32Array:
        """The chart of each point (n,); with `seen` the likeliest that is no opening."""
        field = self._field
        if field.chart is None:
            return np.zeros(len(points), np.int32)
        among = len(field.charts) - field.charts.openings if seen else None
        return classify(field.chart, points, among)

    def uv(self, points: Float32Array, charts: IntArray) -> Float32Array:
        """The asset's UV (n, 2) on charts (n,) of this field; (0, 0) on those without UV."""
        field = self._field
        if field.uv is None:
            return np.zeros((len(points), 2), np.float32)
        table = field.charts
        conditioned = field.uv.spec.conditioning != "none"
        uvs = evaluate(field.uv, points, charts if conditioned else None)
        placed = uvs * np.array(table.uv_scale, np.float32) + np.array(table.uv_offset, np.float32)
        return np.where(table.has_uv[charts][:, None], placed, np.float32(0))

    def project(self, points: Float32Array) -> Float32Array:
        """The points moved along the gradient onto the surface, by `PROJECTION_STEPS` Newton steps.

        Exact near the surface, approximate far from it.
        """
        moved = points
        for _ in range(PROJECTION_STEPS):
            values, slopes = gradient(self._field.sdf, moved)
            steepness = np.maximum((slopes * slopes).sum(axis=1, keepdims=True), 0.25)
            moved = moved - values[:, None] * slopes / steepness
        return moved
