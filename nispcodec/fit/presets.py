"""The presets: for each network its topology, its loss and its schedule."""

from __future__ import annotations

from nispcodec.fit.losses import (
    chart_error,
    chart_loss,
    distance_error,
    relative_distance_loss,
    uv_error,
    uv_loss,
)
from nispcodec.fit.task import Objective, Schedule, Task
from nispcodec.mesh.samples import Sampler, SampleSet
from nispcodec.mesh.training import TrainingSets
from nispcodec.network import NetworkSpec

MANY_PATCHES = 100

PAPER_HIDDEN = (64,) * 8
PAPER_LEVELS = 5
STEPS = {"sdf": 7_500, "chart": 4_500, "uv": 4_400}
WIDE_STEPS = {"sdf": 5_000, "chart": 2_800, "uv": 3_800}

PRICES = {"sdf": 0.005, "chart": 0.005, "uv": 0.01}
"""By what share of the loss a bit a weight less may raise it."""

PAPER_STEPS = 40_000
"""What twenty minutes on two cores allow of the published 2000 epochs of 10^6 samples."""


def tasks_for(preset: str, sampler: Sampler, sets: TrainingSets) -> list[Task]:
    """The networks to fit: a chart network for two charts or more, UV where charts have any."""
    table = sampler.table
    needed = {"sdf": True, "chart": len(table) > 1, "uv": bool(table.has_uv.any())}
    if preset == "paper":
        tasks = paper_tasks(len(table), sets)
    else:
        tasks = balanced_tasks(len(table), sampler.patches, sets)
    return [task for task in tasks if needed[task.name]]


def balanced_tasks(charts: int, patches: int, sets: TrainingSets) -> list[Task]:
    """Small sine networks with quantised weights, most of the capacity near the surface, SOAP.

    An asset of many patches of texture gets wider networks and fewer steps, so that it takes no
    longer.
    """
    wide = patches > MANY_PATCHES
    steps = WIDE_STEPS if wide else STEPS
    sdf = NetworkSpec((64 if wide else 48,) * 4, 1)
    chart = NetworkSpec((56 if wide else 40,) * 3, charts)
    uv = NetworkSpec(
        (64 if wide else 40,) * 4, 2, conditioning="embedding", charts=charts, embedding=4
    )
    rate = 5e-4 if wide else 1e-3
    return _tasks(
        sets,
        sdf=(sdf, relative_distance_loss, Schedule(steps["sdf"], rate=rate, price=PRICES["sdf"])),
        chart=(chart, chart_loss, Schedule(steps["chart"], batch=1024, price=PRICES["chart"])),
        uv=(uv, uv_loss, Schedule(steps["uv"], price=PRICES["uv"])),
    )


def paper_tasks(charts: int, sets: TrainingSets) -> list[Task]:
    """The published networks, losses, optimiser and rates (paper, sections 3.2 and 4.1)."""
    slow = Schedule(PAPER_STEPS, rate=1e-4, optimiser="adam")
    fast = Schedule(PAPER_STEPS, rate=5e-4, optimiser="adam")
    return _tasks(
        sets,
        sdf=(paper_sdf(), distance_error, slow),
        chart=(paper_chart(charts), chart_loss, fast),
        uv=(paper_uv(charts), uv_loss, fast),
    )


def paper_sdf() -> NetworkSpec:
    """OverfitSDF: 31,169 weights."""
    return NetworkSpec(PAPER_HIDDEN, 1, "fourier", PAPER_LEVELS, activation="relu", output="tanh")


def paper_chart(charts: int) -> NetworkSpec:
    """point2component: 31,104 + 65 k weights."""
    return NetworkSpec(PAPER_HIDDEN, charts, "fourier", PAPER_LEVELS, w0=1.0)


def paper_uv(charts: int) -> NetworkSpec:
    """point2UV: 31,874 weights."""
    return NetworkSpec(
        PAPER_HIDDEN, 2, "fourier", PAPER_LEVELS, "scalar", charts, w0=1.0, output="sigmoid"
    )


Recipe = tuple[NetworkSpec, Objective, Schedule]


def _tasks(sets: TrainingSets, sdf: Recipe, chart: Recipe, uv: Recipe) -> list[Task]:
    """Give each network its samples and its held-out measure."""
    distance, skin = (sets.distance, sets.held_distance), (sets.skin, sets.held_skin)
    return [
        _task("sdf", sdf, distance, distance_error),
        _task("chart", chart, skin, chart_error),
        _task("uv", uv, skin, uv_error),
    ]


def _task(
    name: str, recipe: Recipe, samples: tuple[SampleSet, SampleSet], error: Objective
) -> Task:
    spec, loss, schedule = recipe
    return Task(name, spec, *samples, loss, error, schedule)
