"""Objectives: a network's loss, the error that judges it, and the cost of rounding its weights.

The three belong together: an `Objective` is one value, so that none can be forgotten.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.train.backend.torch.module import Module
from nispcodec.train.batch import Batch
from nispcodec.train.config import LossConfig


@dataclass(frozen=True)
class Objective(ABC):
    """Loss, held-out error and curvature of one kind of network.

    The curvature says how fast the loss rises about where it is: what rounding the weights costs.
    """

    config: LossConfig

    @abstractmethod
    def loss(self, module: Module, batch: Batch) -> Tensor:
        """To be minimized: a scalar."""

    @abstractmethod
    def error(self, module: Module, batch: Batch) -> Tensor:
        """How far the network is off: a scalar, the same whatever the loss."""

    @abstractmethod
    def factors(self, outputs: Tensor, batch: Batch) -> Tensor:
        """Curvature at outputs (n, k) -> (n, k, r).

        Each point's second derivatives by its outputs are the product of its factor and that one's
        transpose.
        """

    @property
    @abstractmethod
    def damping(self) -> float:
        """Above 0: this share of their mean is added to the second derivatives by each weight."""

    own_curvature = True
    """The curvature is that of the loss itself, and not of something that stands for it."""


class SdfObjective(Objective):
    """Mean |f - SDF| / (|SDF| + near): the nearer to the surface, the more an error costs.

    The logistic loss of the sign comes on top, or the fit settles for |SDF| where detail is fine:
    small on the surface, and never crossing zero. The error is the mean distance.
    """

    def loss(self, module: Module, batch: Batch) -> Tensor:
        """See the class."""
        field, softness = module(batch.points)[:, 0], self.config.sign_softness
        wrong_side = functional.softplus(-field * batch.sdf.sign() / softness) * softness
        error = (field - batch.sdf).abs() + self.config.sign_weight * wrong_side
        return (error / (batch.sdf.abs() + self.config.near)).mean()

    def error(self, module: Module, batch: Batch) -> Tensor:
        """Mean |f - SDF|, normalized frame."""
        return (module(batch.points)[:, 0] - batch.sdf).abs().mean()

    def factors(self, outputs: Tensor, batch: Batch) -> Tensor:
        """(n, 1, 1), the kink of the absolute error rounded off."""
        field, sign, softness = outputs[:, 0], batch.sdf.sign(), self.config.sign_softness
        wrong = torch.sigmoid(-field * sign / softness)
        bent = 1 / (field - batch.sdf).abs().clamp(min=self.config.sdf_rounding)
        bent += self.config.sign_weight / softness * wrong * (1 - wrong) * sign.abs()
        return (bent / (batch.sdf.abs() + self.config.near)).sqrt()[:, None, None]

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.sdf_damping


class PaperSdfObjective(SdfObjective):
    """The paper's: the mean distance (eq. 6) is both loss and error."""

    def loss(self, module: Module, batch: Batch) -> Tensor:
        """Mean |f - SDF|."""
        return self.error(module, batch)


class ChartObjective(Objective):
    """Cross-entropy of the chart; the error is the share of points whose chart is wrong.

    The curvature is not the loss' own, which is flat wherever the chart is sure, and rounding goes
    far enough to change that: it is that of the first chart's lead over the second.
    """

    own_curvature = False

    def loss(self, module: Module, batch: Batch) -> Tensor:
        """See the class."""
        return functional.cross_entropy(module(batch.points), batch.chart)

    def error(self, module: Module, batch: Batch) -> Tensor:
        """Share of points, 0 to 1."""
        return (module(batch.points).argmax(dim=1) != batch.chart).float().mean()

    def factors(self, outputs: Tensor, batch: Batch) -> Tensor:
        """(n, charts, 1)."""
        lead, charts = outputs.topk(2, dim=1)
        doubt = torch.sigmoid((lead[:, 1] - lead[:, 0]) / self.config.sure_lead)
        first, second = (functional.one_hot(chart, outputs.shape[1]) for chart in charts.T)
        bent = doubt * (1 - doubt)
        return ((first - second) * bent.sqrt()[:, None])[:, :, None]

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.chart_damping


class UvObjective(Objective):
    """Mean absolute error of u and v given the true chart.

    The error is the mean distance in the network's UV square, `uv_error_limit` where it is more:
    without that limit a few hard places decide how wide a network is taken for all the rest.
    """

    def loss(self, module: Module, batch: Batch) -> Tensor:
        """See the class."""
        return (module(batch.points, batch.chart) - batch.uv).abs().mean()

    def error(self, module: Module, batch: Batch) -> Tensor:
        """See the class."""
        off = (module(batch.points, batch.chart) - batch.uv).norm(dim=1)
        return off.clamp(max=self.config.uv_error_limit).mean()

    def factors(self, outputs: Tensor, batch: Batch) -> Tensor:
        """(n, 2, 2), the kink of the absolute error rounded off."""
        bent = 0.5 / (outputs - batch.uv).abs().clamp(min=self.config.uv_rounding)
        return torch.diag_embed(bent.sqrt())

    @property
    def damping(self) -> float:
        """See `Objective`."""
        return self.config.uv_damping


OBJECTIVES: dict[str, type[Objective]] = {
    "sdf": SdfObjective,
    "chart": ChartObjective,
    "uv": UvObjective,
}
"""By the name of the network."""
