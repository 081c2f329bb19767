"""The presets: for each network its topology, its loss and its schedule."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from nispcodec.core.network import NetworkSpec
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.dataset.sample_set import SampleSet
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.solid import area
from nispcodec.geometry.symmetry import Mirrors
from nispcodec.train.backend.torch.losses import (
    CURVATURES,
    chart_error,
    chart_loss,
    distance_error,
    relative_distance_loss,
    uv_error,
    uv_loss,
)
from nispcodec.train.sizing import FINE, Hidden
from nispcodec.train.task import Rounding, Schedule, Task

PAPER_HIDDEN = (64,) * 8
PAPER_LEVELS = 5
PAPER_STEPS = 40_000
"""What twenty minutes on two cores allow of the published 2000 epochs of 10^6 samples."""

PRICES = {"sdf": 0.045, "chart": 0.02, "uv": 0.08}
"""How much a bit a weight less may raise the loss, of SDF and UV relative to what is left of it."""

BATCH = 1024
"""With as long a memory as Muon's, more and smaller steps do better than large ones."""

SHARES = {"sdf": 1.0, "chart": 0.5, "uv": 0.47}
"""Of the seconds: the SDF has a core to itself, charts and UVs share the other."""

RATES = {"sdf": 1e-3, "chart": 3e-3, "uv": 1e-3}
FINE_RATE = 5e-4
FINE_TIME = 0.8
"""Assets of fine detail take longer to read and to sample: their fits give that time back."""

MEMORIES = {"sdf": 0.01, "chart": 0.01, "uv": 0.04}
"""Shares of the gradients so far in the momentum: with more, SDFs lose thin parts."""

EMBEDDING = 4
"""Numbers a chart that the UV network is told it by."""

PROBE_BAND = 0.7
"""A short fit needs lower first frequencies, or the SDF is flat for most of it."""

BANDS = {"chart": 1.0, "uv": 2 / 3}
"""First frequencies of the others: on most of the surface UVs are all but straight in x, y, z."""

SDF_LAST = 0.3
"""Relative rate of the SDF's last layer: its bias moves the whole field at once."""

PROBE_HIDDEN = {"sdf": (24,) * 4, "chart": (24,) * 3, "uv": (24,) * 4}
PROBE_STEPS = 1500


@dataclass(frozen=True)
class Effort:
    """`seconds` of one core that the longest fit takes; networks `scale` times as wide.

    `reviews`: of the SDF at least, and at least one in `every` steps; without them parts go missing
    that are a small share of the area.
    `band`: the first frequencies of the SDF, relative to SIREN's.
    """

    seconds: float
    scale: float
    reviews: int
    every: int
    band: float = 1.0


EFFORTS = {
    "fast": Effort(18.0, 0.8, 3, 800, PROBE_BAND),
    "balanced": Effort(100.0, 1.0, 9, 800),
    "best": Effort(560.0, 1.2, 15, 4000),
}


@dataclass(frozen=True)
class Problem:
    """What the networks of an asset are asked for; `area` of the surface (normalized frame)."""

    sets: TrainingSets
    charts: int
    has_uv: bool
    area: float
    mirrors: Mirrors

    @staticmethod
    def of(sampler: Sampler, sets: TrainingSets) -> Problem:
        """The problem of a sampled asset."""
        table = sampler.table
        surface = float(area(sampler.solid.pieces).sum())
        return Problem(sets, len(table), bool(table.has_uv.any()), surface, sampler.mirrors)

    @property
    def networks(self) -> tuple[str, ...]:
        """A chart network for two charts or more, a UV network where charts have any."""
        needed = {"sdf": True, "chart": self.charts > 1, "uv": self.has_uv}
        return tuple(name for name, is_needed in needed.items() if is_needed)

    def specs(self, hidden: Hidden) -> dict[str, NetworkSpec]:
        """Sine networks with these hidden layers."""
        return {name: self._spec(name, hidden[name]) for name in self.networks}

    def _spec(self, name: str, hidden: tuple[int, ...]) -> NetworkSpec:
        if name == "sdf":
            return NetworkSpec(hidden, 1, mirror=self.mirrors.sdf)
        if name == "chart":
            return NetworkSpec(hidden, self.charts, mirror=self.mirrors.uv)
        return NetworkSpec(
            hidden,
            2,
            conditioning="chart_affine",
            charts=self.charts,
            embedding=EMBEDDING,
            mirror=self.mirrors.uv,
        )


def probes(problem: Problem) -> list[Task]:
    """Small networks and short fits that tell how much there is to learn."""
    specs = problem.specs(PROBE_HIDDEN)
    return [
        _task(problem.sets, name, spec, _schedule(name, PROBE_STEPS, PROBE_BAND))
        for name, spec in specs.items()
    ]


def sine_tasks(
    problem: Problem,
    hidden: Hidden,
    effort: Effort,
    errors: Mapping[str, float],
    budgets: Mapping[str, float],
) -> list[Task]:
    """Small sine networks with rounded weights, most of the capacity near the surface.

    errors   held-out errors of the probes, by name
    budgets  bits for each network; without one the price decides
    """
    fine = errors["sdf"] > FINE
    sets = problem.sets.with_scarce() if fine else problem.sets
    seconds = effort.seconds * (FINE_TIME if fine else 1.0)
    rates = RATES | ({"sdf": FINE_RATE} if fine else {})
    tasks = []
    for name, spec in problem.specs(hidden).items():
        steps = steps_in(seconds * SHARES[name], spec)
        schedule = replace(
            _schedule(name, steps, effort.band),
            rate=rates[name],
            reviews=max(effort.reviews, steps // effort.every) if name == "sdf" else 0,
        )
        rounding = Rounding(CURVATURES[name], PRICES[name], budgets.get(name, 0.0))
        tasks.append(replace(_task(sets, name, spec, schedule), rounding=rounding))
    return tasks


def _schedule(name: str, steps: int, band: float) -> Schedule:
    schedule = Schedule(steps, BATCH, RATES[name], memory=MEMORIES[name])
    if name == "sdf":
        return replace(schedule, band=band, last=SDF_LAST)
    return replace(schedule, band=BANDS[name])


def steps_in(seconds: float, spec: NetworkSpec) -> int:
    """How many steps take so long on one core of 2.5 GHz (measured; a model of two terms)."""
    return max(1, round(seconds / (1.1e-3 + 1.2e-8 * BATCH * sum(spec.hidden))))


def paper_tasks(charts: int, sets: TrainingSets) -> list[Task]:
    """The published networks, losses, optimizer and rates (paper, sections 3.2 and 4.1)."""
    slow = Schedule(PAPER_STEPS, rate=1e-4, optimizer="adam")
    fast = Schedule(PAPER_STEPS, rate=5e-4, optimizer="adam")
    samples = _samples(sets)
    return [
        Task("sdf", paper_sdf(), *samples["sdf"], distance_error, distance_error, slow),
        Task("chart", paper_chart(charts), *samples["chart"], *_LOSSES["chart"], fast),
        Task("uv", paper_uv(charts), *samples["uv"], *_LOSSES["uv"], fast),
    ]


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


def _task(sets: TrainingSets, name: str, spec: NetworkSpec, schedule: Schedule) -> Task:
    """A sine network's task, with its samples, loss and held-out measure."""
    return Task(name, spec, *_samples(sets)[name], *_LOSSES[name], schedule)


_LOSSES = {
    "sdf": (relative_distance_loss, distance_error),
    "chart": (chart_loss, chart_error),
    "uv": (uv_loss, uv_error),
}


def _samples(sets: TrainingSets) -> dict[str, tuple[SampleSet, SampleSet]]:
    """What each network learns from and what it is judged by."""
    return {
        "sdf": (sets.distance, sets.held_distance),
        "chart": (sets.charts, sets.held_skin),
        "uv": (sets.textured, sets.held_skin),
    }
