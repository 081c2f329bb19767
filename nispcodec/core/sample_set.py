"""Labeled training points: where they lie, how far from the surface, on which chart, which UV."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, IntArray


@dataclass(frozen=True)
class SampleSet:
    """n labeled points, normalized frame: points (n, 3), sdf (n,), chart (n,), uv (n, 2).

    uv is the UV network's target: the asset's UV mapped to [0, 1] by the chart table, (0, 0) on
    charts without UV.
    """

    points: Float32Array
    sdf: Float32Array
    chart: Int32Array
    uv: Float32Array

    @staticmethod
    def joined(parts: tuple[SampleSet, ...]) -> SampleSet:
        """All parts, concatenated."""
        return SampleSet(
            np.concatenate([part.points for part in parts]),
            np.concatenate([part.sdf for part in parts]),
            np.concatenate([part.chart for part in parts]),
            np.concatenate([part.uv for part in parts]),
        )

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, chosen: BoolArray | IntArray | slice) -> SampleSet:
        return SampleSet(self.points[chosen], self.sdf[chosen], self.chart[chosen], self.uv[chosen])
