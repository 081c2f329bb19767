"""One network to fit: its topology, its data, what it minimizes and how."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import torch
from torch import Tensor

from nispcodec.core.network import NetworkSpec
from nispcodec.dataset.sample_set import SampleSet
from nispcodec.train.backend.torch.module import Module
from nispcodec.train.prune import Pruning


@dataclass(frozen=True)
class Batch:
    """Labeled points as tensors: points (n, 3), sdf (n,), chart (n,) int64, uv (n, 2)."""

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

    def __len__(self) -> int:
        return len(self.points)

    def chosen(self, rows: Tensor) -> Batch:
        """The points with these numbers; `index_select` is several times as fast as brackets."""
        everything = (self.points, self.sdf, self.chart, self.uv)
        return Batch(*(part.index_select(0, rows) for part in everything))

    def parts(self, size: int) -> Iterator[Batch]:
        """The batches of `size` points that this one holds; points left over are left out."""
        for start in range(0, len(self) - size + 1, size):
            rows = slice(start, start + size)
            yield Batch(self.points[rows], self.sdf[rows], self.chart[rows], self.uv[rows])


Objective = Callable[[Module, Batch], Tensor]


@dataclass(frozen=True)
class Curvature:
    """How fast a loss rises about where it is: what rounding the weights will cost.

    factors(outputs (n, k), batch) -> (n, k, r): each point's second derivatives by its outputs are
    the product of its factor and that one's transpose. `damping` above 0, as a share of their mean,
    is added to the second derivatives by each weight: the less they hold further off, the more.
    `own`: it is that of the task's loss itself, and not of something that stands for it.
    """

    factors: Callable[[Tensor, Batch], Tensor]
    damping: float
    own: bool = True


@dataclass(frozen=True)
class Rounding:
    """How finely weights are rounded, and by what `curvature` of the loss.

    price   how much a bit a weight less may raise the loss, as its curvature has it; where that is
            the loss' own, a share of what the fit is left with: so every asset has its own lambda
    budget  bits that all weights together take; 0: as the price says
    """

    curvature: Curvature
    price: float
    budget: float = 0.0


@dataclass(frozen=True)
class Schedule:
    """How long and how fast: `steps` of `batch` points; `rate` is warmed up, then held or lowered.

    `optimizer` is "muon" (for hidden layers, SOAP for all else; rate warmed up, then a cosine down
    to a hundredth; weights averaged) or "adam" (rate held, as the paper does).

    band    frequencies that the first layer starts with, relative to SIREN's
    last    rate of the last layer, relative to the others'
    memory  share of the gradients so far that the momentum of hidden layers holds
    reviews how often samples of a signed distance are sought that are on the wrong side
    """

    steps: int
    batch: int = 2048
    rate: float = 1e-3
    optimizer: str = "muon"
    band: float = 1.0
    last: float = 1.0
    memory: float = 0.01
    reviews: int = 0


@dataclass(frozen=True)
class Task:
    """Fit `spec` to `samples` by minimizing `loss`; `error` on `held_out` says how good it is.

    Without `rounding` the weights stay float32.
    """

    name: str
    spec: NetworkSpec
    samples: SampleSet
    held_out: SampleSet
    loss: Objective
    error: Objective
    schedule: Schedule
    rounding: Rounding | None = None
    pruning: Pruning | None = None
