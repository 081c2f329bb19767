"""Optimizers: Muon and SOAP together, or Adam as the paper has it."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

from nispcodec.core.arrays import IndexArray
from nispcodec.train.backend.torch.muon import Muon
from nispcodec.train.backend.torch.soap import Soap
from nispcodec.train.backend.torch.stack import Matrices
from nispcodec.train.layout import WeightLayout
from nispcodec.train.task import Task

Step = Callable[[float], None]
"""To be called after `backward`, with the rate."""


def optimizer(weights: Tensor, task: Task) -> Step:
    """A new one, which remembers nothing yet."""
    if task.schedule.optimizer == "adam":
        return _adam(weights)
    hidden, others = _matrices(task)
    soap = Soap(weights, others, task.config.soap)
    if not hidden:
        return soap.step
    muon = Muon(weights, hidden, task.schedule.momentum_share, task.config.muon)

    def step(rate: float) -> None:
        soap.step(rate)
        muon.step(rate)

    return step


def _matrices(task: Task) -> tuple[Matrices, Matrices]:
    """Those from one hidden layer to the next, then all others, with relative rates."""
    layout = WeightLayout(task.spec)
    scales = [layout.scales[f"weight.{i}"] for i in range(len(task.spec.hidden))]
    rates = [*scales, task.schedule.last_layer_lr_scale]
    layers = [_with_rate(*each) for each in zip(layout.layers, rates, strict=True)]
    tables = [] if layout.tables is None else [_with_rate(layout.tables, 1.0)]
    return layers[1:-1], [layers[0], layers[-1], *tables]


def _with_rate(places: IndexArray, rate: float) -> tuple[Tensor, float]:
    return torch.from_numpy(places), rate


def _adam(weights: Tensor) -> Step:
    adam = torch.optim.Adam([weights])

    def step(rate: float) -> None:
        adam.param_groups[0]["lr"] = rate
        adam.step()

    return step
