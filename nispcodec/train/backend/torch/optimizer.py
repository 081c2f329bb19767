"""What moves a network's weights by their gradient: Muon and SOAP, or Adam as the paper has it."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

from nispcodec.train.backend.torch.module import Module
from nispcodec.train.backend.torch.muon import Muon
from nispcodec.train.backend.torch.soap import Soap
from nispcodec.train.task import Schedule

Move = Callable[[float], None]
"""To be called after `backward`, with the rate."""


def optimizer(module: Module, schedule: Schedule) -> Move:
    """A new one, which remembers nothing yet."""
    if schedule.optimizer == "adam":
        return _adam(module.weights)
    hidden, others = module.matrices(schedule.last)
    soap = Soap(module.weights, others)
    if not hidden:
        return soap.step
    muon = Muon(module.weights, hidden, schedule.memory)

    def move(rate: float) -> None:
        soap.step(rate)
        muon.step(rate)

    return move


def _adam(weights: Tensor) -> Move:
    adam = torch.optim.Adam([weights])

    def move(rate: float) -> None:
        adam.param_groups[0]["lr"] = rate
        adam.step()

    return move
