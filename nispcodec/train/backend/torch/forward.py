"""A network's answers in torch: `nispcodec.infer.evaluate` with gradients."""

from __future__ import annotations

import math

import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.core.network import TABLES, NetworkSpec
from nispcodec.train.layout import WeightLayout

_OUTPUTS = {"identity": lambda values: values, "tanh": torch.tanh, "sigmoid": torch.sigmoid}


class Forward:
    """The network of a layout, whose weights are one vector; on a device."""

    def __init__(self, layout: WeightLayout, device: str) -> None:
        self.spec = layout.spec
        self._shapes = layout.spec.shapes
        self._counts = [math.prod(shape) for shape in self._shapes.values()]
        self._mirrored = torch.tensor(layout.spec.mirrored, device=device)

    def __call__(self, weights: Tensor, points: Tensor, charts: Tensor) -> Tensor:
        """Weights (weights,), points (n, 3), chart numbers (n,) -> (n, outputs)."""
        parts = self._parts(weights)
        points = self._coordinates(points)
        rows = self._rows(parts, charts)
        hidden = _encoded(self.spec, points, charts, rows)
        activation = torch.sin if self.spec.activation == "sine" else functional.relu
        last = len(self.spec.hidden)
        for i in range(last):
            hidden = activation(functional.linear(hidden, parts[f"weight.{i}"], parts[f"bias.{i}"]))
        output = functional.linear(hidden, parts[f"weight.{last}"], parts[f"bias.{last}"])
        if self.spec.conditioning == "chart_affine":
            output = output + _affine(self.spec, points, rows)
        return _OUTPUTS[self.spec.output](output)

    def _parts(self, vector: Tensor) -> dict[str, Tensor]:
        parts = zip(self._shapes.items(), torch.split(vector, self._counts), strict=True)
        return {name: part.view(shape) for (name, shape), part in parts}

    def _coordinates(self, points: Tensor) -> Tensor:
        if not self.spec.mirror:
            return points
        folded = torch.where(self._mirrored, points.abs(), points)
        signed = (points[:, axis : axis + 1] for axis in self.spec.signed_axes)
        return torch.cat([folded, *signed], dim=1)

    def _rows(self, parts: dict[str, Tensor], charts: Tensor) -> Tensor:
        """What the tables say of each point's chart, side by side."""
        tables = [parts[name] for name in TABLES if name in parts]
        if not tables:
            return torch.zeros(0)
        return functional.embedding(charts, torch.cat(tables, dim=1))


def _affine(spec: NetworkSpec, points: Tensor, rows: Tensor) -> Tensor:
    """The affine map of each point's chart (n, outputs)."""
    outputs = spec.outputs
    slopes = rows[:, spec.embedding : -outputs].view(len(points), outputs, -1)
    return rows[:, -outputs:] + (slopes @ points[:, :, None])[:, :, 0]


def _encoded(spec: NetworkSpec, points: Tensor, charts: Tensor, rows: Tensor) -> Tensor:
    if spec.conditioning == "scalar":
        scalar = (2 * charts[:, None] + 1) / spec.charts - 1
        points = torch.cat([points, scalar.to(points.dtype)], dim=1)
    if spec.encoding == "fourier":
        points = _fourier(points, spec.levels)
    return torch.cat([points, rows[:, : spec.embedding]], dim=1) if spec.embedding else points


def _fourier(points: Tensor, levels: int) -> Tensor:
    """sin and cos of 2^i pi p for every coordinate p (paper, eq. 7)."""
    octaves = math.pi * 2.0 ** torch.arange(levels, dtype=points.dtype, device=points.device)
    angles = points[:, :, None] * octaves
    return torch.stack([angles.sin(), angles.cos()], dim=3).flatten(1)
