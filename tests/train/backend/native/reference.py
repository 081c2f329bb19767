"""The torch backend as the kernel is compared with, and networks and samples to do it on."""

from __future__ import annotations

import numpy as np
import torch

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray, Int32Array
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.native.settings import Settings
from nispcodec.train.backend.native.trainer import NativeTrainer
from nispcodec.train.backend.torch.batch import Batch
from nispcodec.train.backend.torch.forward import Forward
from nispcodec.train.backend.torch.losses import LOSSES
from nispcodec.train.backend.torch.trainer import TorchTrainer
from nispcodec.train.config import LoopConfig, TrainConfig
from nispcodec.train.initialization import initial_weights
from nispcodec.train.layout import WeightLayout
from nispcodec.train.objectives import OBJECTIVES
from nispcodec.train.task import Schedule, Task

# The running mean is over a tenth of the steps, here ten.
CONFIG = TrainConfig(loop=LoopConfig(ema_share=0.1))
SCHEDULE = Schedule(100, momentum_share=0.04, last_layer_lr_scale=0.3)
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
    first = initial_weights(spec)
    first += np.random.default_rng(seed).normal(0, 0.02, first.size).astype(np.float32)
    return first


def native(name: str, isa: str | None = None, kept: Float32Array | None = None) -> NativeTrainer:
    """The kernel's trainer of a case, with `some_weights` and `samples`."""
    spec, loss = CASES[name]
    start = some_weights(spec)
    return NativeTrainer(spec, samples(spec), loss, start, kept, SETTINGS, isa=isa)


def by_torch(name: str, kept: Float32Array | None = None) -> TorchTrainer:
    """The same with torch."""
    spec, loss = CASES[name]
    objective = OBJECTIVES[loss](CONFIG.loss)
    found = samples(spec)
    task = Task(name, spec, found, found, objective, SCHEDULE, config=CONFIG)
    return TorchTrainer(task, some_weights(spec), kept, "cpu")


def exact_gradient(case: str | NetworkSpec, chosen: Int32Array) -> tuple[float, Float64Array]:
    """Loss and gradient of some samples by torch in float64; of an SDF for a spec."""
    spec, loss = (case, "sdf") if isinstance(case, NetworkSpec) else CASES[case]
    batch = Batch.of(samples(spec)[chosen], "cpu")
    exact = Batch(batch.points.double(), batch.sdf.double(), batch.chart, batch.uv.double())
    weights = torch.from_numpy(some_weights(spec)).double().requires_grad_()
    outputs = Forward(WeightLayout(spec), "cpu")(weights, exact.points, exact.chart)
    found = LOSSES[loss](outputs, exact, CONFIG.loss)
    (gradient,) = torch.autograd.grad(found, weights)
    return float(found.detach()), gradient.numpy()


def relative(found: FloatArray, wanted: FloatArray) -> float:
    """The norm of the difference, relative to the wanted one's."""
    return float(np.linalg.norm(found - wanted) / np.linalg.norm(wanted))
