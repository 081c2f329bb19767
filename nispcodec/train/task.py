"""One network to fit: its topology, its data, what it minimizes and how."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.config import TrainConfig
from nispcodec.train.objectives import Objective
from nispcodec.train.prune import Pruning


@dataclass(frozen=True)
class Quantization:
    """How finely weights are rounded.

    lambda_     how much a bit a weight less may raise the loss, as the objective's curvature has
                it; where that is the loss' own, a share of what the fit is left with: so every
                asset has a lambda of its own
    coarser     octaves by which all steps are longer than lambda has them: a bit less of every
                weight, so that what they cost stays alike everywhere
    rise        times the held-out error that it may cost before it is tried again, if that is more
                than `QuantizeConfig` says
    """

    lambda_: float
    coarser: float = 0.0
    rise: float = 1.0


@dataclass(frozen=True)
class Schedule:
    """How long and how fast: `steps` of `batch` points; `rate` is warmed up, then held or lowered.

    `optimizer` is "muon" (for hidden layers, SOAP for all else; rate warmed up, then a cosine;
    weights averaged) or "adam" (rate held, as the paper does).

    w0_scale             frequencies that the first layer starts with, relative to SIREN's
    last_layer_lr_scale  rate of the last layer, relative to the others'
    momentum_share       share of the gradients so far that the momentum of hidden layers holds
    minings              how often samples of a signed distance are sought that are on the wrong
                         side
    """

    steps: int
    batch: int = 2048
    rate: float = 1e-3
    optimizer: str = "muon"
    w0_scale: float = 1.0
    last_layer_lr_scale: float = 1.0
    momentum_share: float = 0.01
    minings: int = 0


@dataclass(frozen=True)
class Task:
    """Fit `spec` to `samples` by an objective, whose error on `held_out` says how good it is.

    Without `quantization` the weights stay float32. `fitted` is the network of an earlier fit of
    this task, which is only to be rounded; None: none is. `foreseen` is the held-out error that a
    fit of this task should end below; infinite where nobody knows. `starts` fits are made from as
    many initial weights, and the best is kept.
    """

    name: str
    spec: NetworkSpec
    samples: SampleSet
    held_out: SampleSet
    objective: Objective
    schedule: Schedule
    quantization: Quantization | None = None
    pruning: Pruning | None = None
    fitted: Network | None = None
    foreseen: float = math.inf
    starts: int = 1
    config: TrainConfig = field(default_factory=TrainConfig)

    @property
    def mean_weight(self) -> float:
        """The share of the newest weights in the running mean of the weights."""
        if self.schedule.optimizer == "adam":
            return 1.0
        return 1 / max(1.0, self.config.loop.ema_share * self.schedule.steps)
