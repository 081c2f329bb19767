"""The tasks of an asset: for each network its topology, samples, objective and schedule."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.train.config import PaperConfig, TrainConfig, TrainingBudget
from nispcodec.train.objectives import OBJECTIVES, PaperSdfObjective
from nispcodec.train.sizing import Hidden, foreseen, is_fine
from nispcodec.train.task import Quantization, Schedule, Task


@dataclass(frozen=True)
class AssetProblem:
    """Everything about an asset that the tasks of its networks depend on.

    charts     labels, an opening's included
    has_uv     whether any chart has UVs
    area       of the surface (normalized frame)
    sdf_mirror, uv_mirror   `mirror` of the SDF, and of the chart and UV networks
    """

    sets: TrainingSets
    charts: int
    has_uv: bool
    area: float
    sdf_mirror: int
    uv_mirror: int
    config: TrainConfig = field(default_factory=TrainConfig)

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
            return NetworkSpec(hidden, 1, mirror=self.sdf_mirror)
        if name == "chart":
            return NetworkSpec(hidden, self.charts, mirror=self.uv_mirror)
        return NetworkSpec(
            hidden,
            2,
            conditioning="chart_affine",
            charts=self.charts,
            embedding=self.config.embedding,
            mirror=self.uv_mirror,
        )


def probes(problem: AssetProblem) -> list[Task]:
    """Small networks and short fits that tell how much there is to learn."""
    config = problem.config
    specs = problem.specs({name: each.probe_hidden for name, each in config.networks.items()})
    return [
        _task(
            problem.sets,
            name,
            spec,
            _schedule(name, config.probe_steps, config.probe_w0_scale, config),
            config,
        )
        for name, spec in specs.items()
    ]


def sine_tasks(
    problem: AssetProblem,
    hidden: Hidden,
    budget: TrainingBudget,
    errors: Mapping[str, float],
) -> list[Task]:
    """Small sine networks with rounded weights, most of the capacity near the surface.

    errors: held-out errors of the probes, by name.
    """
    config = problem.config
    fine = is_fine(errors, config.sizing)
    sets = problem.sets.with_undersampled_charts() if fine else problem.sets
    most = budget.steps * (config.fine_steps if fine else 1.0)
    tasks = []
    for name, spec in problem.specs(hidden).items():
        learning = config.networks[name]
        # Large networks gain by every step, others by another start.
        starts = budget.starts if name == "sdf" and not fine else 1
        steps = max(1, round(most * learning.step_share / starts))
        schedule = _schedule(name, steps, budget.w0_scale, config)
        if name == "sdf":
            rate = config.fine_rate if fine else learning.learning_rate
            minings = max(budget.minings, steps // budget.mine_every)
            schedule = replace(schedule, rate=rate, minings=minings)
        quantization = Quantization(learning.lambda_, rise=budget.rounding)
        task = _task(sets, name, spec, schedule, config)
        expected = math.inf
        if steps > config.loop.least_to_judge * config.probe_steps:
            expected = foreseen(errors[name], learning.probe_hidden, spec.hidden)
        tasks.append(replace(task, quantization=quantization, foreseen=expected, starts=starts))
    return tasks


def paper_tasks(charts: int, sets: TrainingSets, config: TrainConfig) -> list[Task]:
    """The published networks, losses, optimizer and rates (paper, sections 3.2 and 4.1)."""
    paper, kinds = config.paper, OBJECTIVES | {"sdf": PaperSdfObjective}
    specs = {
        "sdf": paper_sdf(paper),
        "chart": paper_chart(charts, paper),
        "uv": paper_uv(charts, paper),
    }
    fast = Schedule(paper.steps, paper.batch, paper.rate, optimizer="adam")
    slow = replace(fast, rate=paper.sdf_rate)
    samples = _samples(sets)
    return [
        Task(
            name,
            spec,
            *samples[name],
            kinds[name](config.loss),
            slow if name == "sdf" else fast,
            config=config,
        )
        for name, spec in specs.items()
    ]


def paper_sdf(paper: PaperConfig = PaperConfig()) -> NetworkSpec:
    """OverfitSDF: 31,169 weights."""
    return NetworkSpec(paper.hidden, 1, "fourier", paper.levels, activation="relu", output="tanh")


def paper_chart(charts: int, paper: PaperConfig = PaperConfig()) -> NetworkSpec:
    """point2component: 31,104 + 65 k weights."""
    return NetworkSpec(paper.hidden, charts, "fourier", paper.levels, w0=1.0)


def paper_uv(charts: int, paper: PaperConfig = PaperConfig()) -> NetworkSpec:
    """point2UV: 31,874 weights."""
    return NetworkSpec(
        paper.hidden, 2, "fourier", paper.levels, "scalar", charts, w0=1.0, output="sigmoid"
    )


def _schedule(name: str, steps: int, sdf_w0_scale: float, config: TrainConfig) -> Schedule:
    learning = config.networks[name]
    return Schedule(
        steps,
        config.batch,
        learning.learning_rate,
        w0_scale=sdf_w0_scale if name == "sdf" else learning.w0_scale,
        last_layer_lr_scale=learning.last_layer_lr_scale,
        momentum_share=learning.momentum_share,
    )


def _task(
    sets: TrainingSets, name: str, spec: NetworkSpec, schedule: Schedule, config: TrainConfig
) -> Task:
    """A sine network's task, with its samples and objective."""
    objective = OBJECTIVES[name](config.loss)
    return Task(name, spec, *_samples(sets)[name], objective, schedule, config=config)


def _samples(sets: TrainingSets) -> dict[str, tuple[SampleSet, SampleSet]]:
    """By network, the samples that it learns from and those that it is judged by."""
    return {
        "sdf": (sets.distance, sets.held_out_distance),
        "chart": (sets.charts, sets.held_out_surface),
        "uv": (sets.uvs, sets.held_out_surface),
    }
