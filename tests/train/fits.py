"""Small fits: a ball whose halves are charts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Progress, silent
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.torch.engine import TorchEngine
from nispcodec.train.config import LossConfig
from nispcodec.train.cores import one_core
from nispcodec.train.loop import train
from nispcodec.train.objectives import ChartObjective, SdfObjective, UvObjective
from nispcodec.train.prune import Mask
from nispcodec.train.task import Schedule, Task

ENGINE = TorchEngine("cpu")
SDF = SdfObjective(LossConfig())


def ball_samples(count: int, seed: int) -> SampleSet:
    """Distances to a ball of radius 1/2, its two halves as charts, x and y as UVs."""
    points = np.random.default_rng(seed).uniform(-1, 1, (count, 3)).astype(np.float32)
    sdf = np.linalg.norm(points, axis=1) - np.float32(0.5)
    return SampleSet(points, sdf, (points[:, 0] > 0).astype(np.int32), points[:, :2].copy())


def sdf_task(steps: int = 300, rate: float = 1e-3, optimizer: str = "muon") -> Task:
    spec = NetworkSpec((16, 16), 1, w0=5.0)
    schedule = Schedule(steps, 256, rate, optimizer)
    return Task("sdf", spec, ball_samples(4000, 0), ball_samples(500, 1), SDF, schedule)


def chart_task(steps: int = 300) -> Task:
    objective = ChartObjective(LossConfig())
    return replace(sdf_task(steps), name="chart", spec=NetworkSpec((8,), 2), objective=objective)


def uv_task(steps: int = 300) -> Task:
    spec = NetworkSpec((8, 8), 2, conditioning="chart_affine", charts=2, embedding=3)
    return replace(sdf_task(steps), name="uv", spec=spec, objective=UvObjective(LossConfig()))


def judged_by(task: Task, error: Callable[[Float32Array, SampleSet], float]) -> Task:
    """The task with another held-out error."""
    kind = type("Judged", (type(task.objective),), {"error": staticmethod(error)})
    return replace(task, objective=kind(LossConfig()))


def run(
    task: Task,
    listen: Callable[[Progress], None] = silent,
    seed: int = 0,
    mask: Mask | None = None,
) -> Network:
    """The task's network, by the reference engine."""
    return train(task, seed, ENGINE, one_core, listen, mask)
