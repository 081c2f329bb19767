"""The losses of `nispcodec.train.objectives`, with gradients."""

from __future__ import annotations

from collections.abc import Callable

from torch import Tensor
from torch.nn import functional

from nispcodec.train.backend.torch.batch import Batch
from nispcodec.train.config import LossConfig

Loss = Callable[[Tensor, Batch, LossConfig], Tensor]
"""Of a network's outputs (n, k): a scalar."""


def _sdf(outputs: Tensor, batch: Batch, config: LossConfig) -> Tensor:
    field, softness = outputs[:, 0], config.sign_softness
    wrong_side = functional.softplus(-field * batch.sdf.sign() / softness) * softness
    error = (field - batch.sdf).abs() + config.sign_weight * wrong_side
    return (error / (batch.sdf.abs() + config.near)).mean()


def _paper_sdf(outputs: Tensor, batch: Batch, config: LossConfig) -> Tensor:
    return (outputs[:, 0] - batch.sdf).abs().mean()


def _chart(outputs: Tensor, batch: Batch, config: LossConfig) -> Tensor:
    return functional.cross_entropy(outputs, batch.chart)


def _uv(outputs: Tensor, batch: Batch, config: LossConfig) -> Tensor:
    return (outputs - batch.uv).abs().mean()


LOSSES: dict[str, Loss] = {"sdf": _sdf, "paper_sdf": _paper_sdf, "chart": _chart, "uv": _uv}
"""By `Objective.loss_name`."""
