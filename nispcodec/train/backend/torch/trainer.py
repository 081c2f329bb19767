"""A network under training in torch: the reference, and the backend of CUDA and of the paper."""

from __future__ import annotations

import numpy as np
import torch
from torch import Tensor
from torch.func import grad, vmap

from nispcodec.core.arrays import Float32Array, Int32Array, Int64Array, IntArray
from nispcodec.train.backend.torch.batch import Batch
from nispcodec.train.backend.torch.forward import Forward
from nispcodec.train.backend.torch.losses import LOSSES
from nispcodec.train.backend.torch.optimizer import optimizer
from nispcodec.train.layout import WeightLayout
from nispcodec.train.task import Task

TINY = 1e-12


class TorchTrainer:
    """See `nispcodec.train.backend.protocol.Trainer`."""

    threads = 1

    def __init__(
        self, task: Task, weights: Float32Array, kept: Float32Array | None, device: str
    ) -> None:
        # The fit's thread has a count of its own; operations this small wait for more than one.
        torch.set_num_threads(1)
        self._task, self._device = task, device
        self._forward = Forward(WeightLayout(task.spec), device)
        self._loss = LOSSES[task.objective.loss_name]
        self._samples = Batch.of(task.samples, device)
        self._kept = None if kept is None else torch.from_numpy(kept).to(device)
        self._weights = torch.zeros(len(weights), device=device, requires_grad=True)
        self.restart(weights)

    @property
    def weights(self) -> Float32Array:
        """See `Trainer`."""
        return _array(self._weights)

    @property
    def mean(self) -> Float32Array:
        """See `Trainer`."""
        return _array(self._mean)

    @torch.no_grad()
    def restart(self, weights: Float32Array) -> None:
        """See `Trainer`."""
        self._weights.copy_(torch.from_numpy(weights))
        if self._kept is not None:
            self._weights.mul_(self._kept)
        self._mean = self._weights.detach().clone()
        self._move = optimizer(self._weights, self._task)

    def steps(self, rows: Int32Array, rates: Float32Array) -> Float32Array:
        """See `Trainer`."""
        losses = [self._step(*each) for each in zip(rows, rates, strict=True)]
        return torch.stack(losses).cpu().numpy()

    def gradient(self, rows: Int32Array) -> tuple[float, Float32Array]:
        """See `Trainer`."""
        loss = self._backward(rows)
        assert self._weights.grad is not None
        return float(loss), _array(self._weights.grad)

    @torch.no_grad()
    def outputs(
        self, weights: Float32Array, points: Float32Array, charts: IntArray
    ) -> Float32Array:
        """See `Trainer`."""
        seen, numbers = self._placed(points, charts)
        size, used = self._task.config.batch_of_outputs, torch.from_numpy(weights).to(self._device)
        parts = zip(torch.split(seen, size), torch.split(numbers, size), strict=True)
        return torch.cat([self._forward(used, *each) for each in parts]).cpu().numpy()

    def slopes(
        self,
        weights: Float32Array,
        points: Float32Array,
        charts: IntArray,
        directions: Float32Array,
        places: Int64Array | None = None,
    ) -> Float32Array:
        """See `Trainer`."""

        def along(used: Tensor, point: Tensor, chart: Tensor, direction: Tensor) -> Tensor:
            return self._forward(used, point[None], chart[None])[0] @ direction

        every = vmap(grad(along), in_dims=(None, 0, 0, 0))
        used, wanted = (torch.from_numpy(each).to(self._device) for each in (weights, directions))
        found = _array(every(used, *self._placed(points, charts), wanted))
        return found if places is None else found[:, places]

    def _step(self, rows: Int32Array, rate: np.float32) -> Tensor:
        loss = self._backward(rows)
        self._clip()
        self._move(float(rate))
        with torch.no_grad():
            if self._kept is not None:
                self._weights.mul_(self._kept)
            self._mean.lerp_(self._weights, self._task.mean_weight)
        return loss

    def _backward(self, rows: Int32Array) -> Tensor:
        batch = self._samples.chosen(torch.from_numpy(rows).long().to(self._device))
        used = self._weights if self._kept is None else self._weights * self._kept
        outputs = self._forward(used, batch.points, batch.chart)
        loss = self._loss(outputs, batch, self._task.config.loss)
        self._weights.grad = None
        torch.autograd.backward(loss)
        return loss.detach()

    def _clip(self) -> None:
        gradient = self._weights.grad
        assert gradient is not None
        limit = self._task.config.loop.clip
        gradient.mul_((limit / (gradient.norm() + TINY)).clamp_(max=1.0))

    def _placed(self, points: Float32Array, charts: IntArray) -> tuple[Tensor, Tensor]:
        numbers = torch.from_numpy(charts.astype(np.int64))
        return torch.from_numpy(points).to(self._device), numbers.to(self._device)


def _array(tensor: Tensor) -> Float32Array:
    """A copy."""
    return np.array(tensor.detach().cpu().numpy(), dtype=np.float32)
