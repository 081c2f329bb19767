"""Optimizers: Muon and SOAP together, or Adam as the paper has it."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

from nispcodec.train.backend.torch.module import Module
from nispcodec.train.backend.torch.muon import Muon
from nispcodec.train.backend.torch.soap import Soap
from nispcodec.train.config import TrainConfig
from nispcodec.train.task import Schedule

Step = Callable[[float], None]
"""To be called after `backward`, with the rate."""


def optimizer(module: Module, schedule: Schedule, config: TrainConfig) -> Step:
    """A new one, which remembers nothing yet."""
    if schedule.optimizer == "adam":
        return _adam(module.weights)
    hidden, others = module.matrices(schedule.last_layer_lr_scale)
    soap = Soap(module.weights, others, config.soap)
    if not hidden:
        return soap.step
    muon = Muon(module.weights, hidden, schedule.momentum_share, config.muon)

    def step(rate: float) -> None:
        soap.step(rate)
        muon.step(rate)

    return step


def _adam(weights: Tensor) -> Step:
    adam = torch.optim.Adam([weights])

    def step(rate: float) -> None:
        adam.param_groups[0]["lr"] = rate
        adam.step()

    return step
