"""The torch backend as the kernel is compared with, and networks and samples to do it on."""

from __future__ import annotations

import numpy as np
import torch
from torch import Tensor

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray, Int32Array
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.native.engine import NativeTrainer, Settings
from nispcodec.train.backend.torch.module import Module
from nispcodec.train.backend.torch.muon import Muon
from nispcodec.train.backend.torch.soap import Soap
from nispcodec.train.backend.torch.stack import Matrices
from nispcodec.train.batch import Batch
from nispcodec.train.config import TrainConfig
from nispcodec.train.objectives import OBJECTIVES
from nispcodec.train.soap_bases import bases

CONFIG = TrainConfig()
SETTINGS = Settings.of(CONFIG, momentum_share=0.04, last_layer_rate=0.3, ema_weight=0.1)

CASES: dict[str, tuple[NetworkSpec, str]] = {
    "sdf": (NetworkSpec((24,) * 4, 1), "sdf"),
    "one layer": (NetworkSpec((20,), 1), "sdf"),
    "mirrored": (NetworkSpec((24,) * 3, 1, mirror=0b001), "sdf"),
    "signed axes": (NetworkSpec((16,) * 3, 1, mirror=0b101101, w0=20.0), "sdf"),
    "unequal": (NetworkSpec((30, 17, 40, 9), 1), "sdf"),
    "wide": (NetworkSpec((66,) * 3, 1), "sdf"),
    "charts": (NetworkSpec((30,) * 3, 40), "chart"),
    "two charts, mirrored": (NetworkSpec((18,) * 2, 2, mirror=0b110110), "chart"),
    "uv": (NetworkSpec((22,) * 4, 2), "uv"),
    "uv, embedding": (
        NetworkSpec((22,) * 3, 2, conditioning="embedding", charts=7, embedding=5),
        "uv",
    ),
    "uv, one chart": (
        NetworkSpec((22,) * 4, 2, conditioning="chart_affine", charts=1, embedding=4),
        "uv",
    ),
    "uv, 40 charts": (
        NetworkSpec(
            (22,) * 4, 2, conditioning="chart_affine", charts=40, embedding=4, mirror=0b001001
        ),
        "uv",
    ),
}
"""A network and a loss, by what is special."""


def samples(spec: NetworkSpec, count: int = 3000, seed: int = 0) -> SampleSet:
    """Random ones; some distances are exactly 0."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1, 1, (count, 3)).astype(np.float32)
    sdf = (np.linalg.norm(points, axis=1) - 0.7).astype(np.float32)
    sdf[::10] = 0
    labels = spec.charts or spec.outputs
    chart = rng.integers(0, labels, count).astype(np.int32)
    return SampleSet(points, sdf, chart, rng.uniform(0, 1, (count, 2)).astype(np.float32))


def rows(count: int, batch: int, steps: int = 1, seed: int = 1) -> Int32Array:
    """Random rows (steps, batch) of `count` samples."""
    return np.random.default_rng(seed).integers(0, count, (steps, batch)).astype(np.int32)


def some_weights(spec: NetworkSpec, seed: int = 2) -> Float32Array:
    """Initial ones, and tables and biases that are not 0."""
    first = Module(spec, "cpu").first.numpy().copy()
    first += np.random.default_rng(seed).normal(0, 0.02, first.size).astype(np.float32)
    return first


def native(name: str, isa: str | None = None, kept: Float32Array | None = None) -> NativeTrainer:
    """The kernel's trainer of a case, with `some_weights` and `samples`."""
    spec, loss = CASES[name]
    start = some_weights(spec)
    return NativeTrainer(spec, samples(spec), loss, start, kept, SETTINGS, isa=isa)


class TorchTrainer:
    """The same with torch, one step at a time."""

    def __init__(self, name: str, kept: Float32Array | None = None) -> None:
        spec, loss = CASES[name]
        self.module = Module(spec, "cpu")
        self.objective = OBJECTIVES[loss](CONFIG.loss)
        self.samples = Batch.of(samples(spec), "cpu")
        self.module.weights.data = torch.from_numpy(some_weights(spec))
        if kept is not None:
            self.module.kept = torch.from_numpy(kept)
            self.module.apply_mask()
        hidden, others = self.module.matrices(SETTINGS.last_layer_rate)
        self.soaps = [DefinedSoap(self.module.weights, [matrix]) for matrix in others]
        share = SETTINGS.momentum_share
        self.muon = Muon(self.module.weights, hidden, share, CONFIG.muon) if hidden else None
        self.mean = self.module.weights.detach().clone()

    def gradient(self, chosen: Int32Array) -> tuple[float, Float32Array]:
        """Loss and gradient of some samples."""
        batch = self.samples.chosen(torch.from_numpy(chosen).long())
        loss = self.objective.loss(self.module, batch)
        self.module.weights.grad = None
        loss.backward()  # type: ignore[no-untyped-call]
        assert self.module.weights.grad is not None
        return float(loss.detach()), self.module.weights.grad.numpy()

    def step(self, chosen: Int32Array, rate: float) -> float:
        """One whole step; returns the loss before."""
        loss, _ = self.gradient(chosen)
        gradient = self.module.weights.grad
        assert gradient is not None
        gradient.mul_((SETTINGS.clip / (gradient.norm() + 1e-12)).clamp_(max=1.0))
        for soap in self.soaps:
            soap.step(rate)
        if self.muon is not None:
            self.muon.step(rate)
        self.module.apply_mask()
        self.mean.lerp_(self.module.weights.detach(), SETTINGS.ema_weight)
        return loss

    @property
    def weights(self) -> Float32Array:
        """As they are now."""
        return self.module.weights.detach().numpy()


def exact_gradient(case: str | NetworkSpec, chosen: Int32Array) -> tuple[float, Float64Array]:
    """Loss and gradient of some samples by torch in float64; of an SDF for a spec."""
    spec, loss = (case, "sdf") if isinstance(case, NetworkSpec) else CASES[case]
    module, batch = Module(spec, "cpu"), Batch.of(samples(spec)[chosen], "cpu")
    module.weights = torch.from_numpy(some_weights(spec)).double().requires_grad_()
    exact = Batch(batch.points.double(), batch.sdf.double(), batch.chart, batch.uv.double())
    found = OBJECTIVES[loss](CONFIG.loss).loss(module, exact)
    (gradient,) = torch.autograd.grad(found, module.weights)
    return float(found.detach()), gradient.numpy()


class DefinedSoap(Soap):
    """SOAP whose first bases are those of `nispcodec.train.soap_bases`."""

    def __init__(self, weights: Tensor, matrices: Matrices) -> None:
        super().__init__(weights, matrices, CONFIG.soap)

    def step(self, scale: float) -> None:
        """See `Soap`."""
        new = self.state is None
        super().step(scale)
        if new and self.state is not None:
            left, right = bases(self.stack.gradient()[0].numpy())
            self.state.left_basis = torch.from_numpy(left)[None]
            self.state.right_basis = torch.from_numpy(right)[None]


def relative(found: FloatArray, wanted: FloatArray) -> float:
    """The norm of the difference, relative to the wanted one's."""
    return float(np.linalg.norm(found - wanted) / np.linalg.norm(wanted))
