"""Labeled points as tensors."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from nispcodec.core.sample_set import SampleSet


@dataclass(frozen=True)
class Batch:
    """points (n, 3), sdf (n,), chart (n,) int64, uv (n, 2); float32, normalized frame."""

    points: Tensor
    sdf: Tensor
    chart: Tensor
    uv: Tensor

    @staticmethod
    def of(samples: SampleSet, device: str) -> Batch:
        """The samples on a device."""
        return Batch(
            torch.from_numpy(samples.points).to(device),
            torch.from_numpy(samples.sdf).to(device),
            torch.from_numpy(samples.chart).long().to(device),
            torch.from_numpy(samples.uv).to(device),
        )

    def chosen(self, rows: Tensor) -> Batch:
        """The points with these numbers; `index_select` is several times as fast as brackets."""
        everything = (self.points, self.sdf, self.chart, self.uv)
        return Batch(*(part.index_select(0, rows) for part in everything))
