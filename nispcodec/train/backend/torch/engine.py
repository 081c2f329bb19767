"""The torch backend: every network and device, at the speed of its many small operations."""

from __future__ import annotations

from dataclasses import dataclass

import torch

from nispcodec.core.arrays import Float32Array
from nispcodec.core.errors import FitError
from nispcodec.dataset.hard_examples import error_radii
from nispcodec.train.backend.protocol import ErrorRadii
from nispcodec.train.backend.torch.trainer import TorchTrainer
from nispcodec.train.task import Task


@dataclass(frozen=True)
class TorchEngine:
    """See `nispcodec.train.backend.protocol.Engine`; `device` is one that torch has."""

    device: str
    name = "torch"

    def trainer(self, task: Task, weights: Float32Array, kept: Float32Array | None) -> TorchTrainer:
        """See `Engine`."""
        return TorchTrainer(task, weights, kept, self.device)

    def error_radii(self, task: Task) -> ErrorRadii:
        """See `Engine`."""
        samples = task.samples

        def found(field: Float32Array, limit: float, floaters: bool) -> Float32Array:
            return error_radii(samples.points, samples.sdf, field, limit, floaters)

        return found


def torch_engine(wanted: str) -> TorchEngine:
    """On the device "auto", "cpu", "cuda" or "cuda:1"; auto is CUDA when there is one.

    Raises FitError for a device that is not there.
    """
    cuda = torch.cuda.is_available()
    if wanted == "auto":
        return TorchEngine("cuda" if cuda else "cpu")
    kind, _, number = wanted.partition(":")
    there = cuda and kind == "cuda" and int(number or 0) < torch.cuda.device_count()
    if wanted != "cpu" and not there:
        found = f"cpu, cuda:0 to cuda:{torch.cuda.device_count() - 1}" if cuda else "cpu alone"
        raise FitError(f"device: expected one that torch finds here ({found}), found {wanted!r}")
    return TorchEngine(wanted)
