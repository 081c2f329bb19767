"""Labelled training points: where they lie, how far from the surface, on which chart, which UV."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nispcodec.core.asset import IndexArray

Floats = NDArray[np.float32]


@dataclass(frozen=True)
class SampleSet:
    """n labelled points, normalised frame: points (n, 3), sdf (n,), chart (n,), uv (n, 2).

    uv is the UV network's target: the asset's UV mapped to [0, 1] by the chart table, (0, 0) on
    charts without UV.
    """

    points: Floats
    sdf: Floats
    chart: IndexArray
    uv: Floats

    @staticmethod
    def joined(parts: tuple[SampleSet, ...]) -> SampleSet:
        """All parts, one after the other."""
        return SampleSet(
            np.concatenate([part.points for part in parts]),
            np.concatenate([part.sdf for part in parts]),
            np.concatenate([part.chart for part in parts]),
            np.concatenate([part.uv for part in parts]),
        )

    def __len__(self) -> int:
        return len(self.points)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.integer] | slice) -> SampleSet:
        return SampleSet(self.points[chosen], self.sdf[chosen], self.chart[chosen], self.uv[chosen])
