"""How good or how small: fits an asset's networks with a preset, to a size, or to an error."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from nispcodec.core.document import Document
from nispcodec.core.errors import FitError, NispError, TargetSizeError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Listener, Progress
from nispcodec.format import inspect, pack
from nispcodec.format.constants import NETS, TXTR
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.config import TargetConfig, TrainingBudget
from nispcodec.train.prune import Pruning
from nispcodec.train.sizing import (
    Hidden,
    bytes_of,
    even_width,
    hidden_layers,
    layers,
    scale_for_bytes,
    smallest,
)
from nispcodec.train.task import Task
from nispcodec.train.tasks import AssetProblem, probes, sine_tasks

Networks = dict[str, Network]
Fit = Callable[[list[Task], Listener], Networks]

TRIAL = "probe networks"
"""The stage of networks that are tried."""


@dataclass(frozen=True)
class FitContext:
    """An asset's problem, the budget for it, what is pruned, and what runs tasks."""

    problem: AssetProblem
    budget: TrainingBudget
    fit: Fit
    listen: Listener
    prunings: Mapping[str, Pruning] = field(default_factory=dict)

    @cached_property
    def probed(self) -> dict[str, float]:
        """The held-out errors of the probes, by name."""
        errors: dict[str, float] = {}
        tell = _as_one(self.listen, "probe how much there is to learn")

        def heard(progress: Progress) -> None:
            # The least: what came of a late divergence is no measure, and NaN is none at all.
            known = errors.get(progress.network, math.inf)
            errors[progress.network] = min(known, progress.error)
            tell(progress)

        self.fit(probes(self.problem), heard)
        return errors

    def trial(self) -> Networks:
        """The preset's networks after the few steps of a trial, rounded once."""
        short = replace(self.budget, steps=self.budget.trial, rounding=math.inf)
        hidden = self.hidden_layers(self.probed, self.budget.scale)
        tasks = replace(self, budget=short).tasks(hidden, self.probed)
        once = [replace(task, foreseen=math.inf) for task in tasks]
        return self.fit(once, _as_one(self.listen, TRIAL))

    @property
    def foreseen(self) -> tuple[float, float]:
        """About the bytes of the preset's networks, and the held-out error of the SDF's probe."""
        hidden = self.hidden_layers(self.probed, self.budget.scale)
        specs, sizing = self.problem.specs(hidden), self.problem.config.sizing
        return bytes_of(specs, sizing), self.probed["sdf"]

    def hidden_layers(self, errors: Mapping[str, float], scale: float) -> Hidden:
        """As large as the probes' held-out errors ask for, `scale` times as wide."""
        return hidden_layers(errors, self.problem.area, scale, self.problem.config.sizing)

    def tasks(self, hidden: Hidden, errors: Mapping[str, float]) -> list[Task]:
        """The tasks for networks with these hidden layers."""
        return pruned(sine_tasks(self.problem, hidden, self.budget, errors), self.prunings)


def _as_one(listen: Listener, stage: str) -> Listener:
    """A listener that tells of all networks as of one stage, as far as the slowest of them is."""
    done: dict[str, float] = {}

    def heard(progress: Progress) -> None:
        if progress.steps:
            done[progress.network] = progress.step / progress.steps
            step = round(min(done.values()) * progress.steps)
            listen(Progress(stage=stage, step=step, steps=progress.steps))

    return heard


def pruned(tasks: list[Task], prunings: Mapping[str, Pruning]) -> list[Task]:
    """The tasks, with each network's pruning."""
    return [replace(task, pruning=prunings.get(task.name)) for task in tasks]


def fit_with_preset(context: FitContext, wanted: Callable[[float, float], bool]) -> Networks:
    """Networks as large as the preset and the asset suggest; none if they are not wanted.

    `wanted` is told their bytes, about, and the held-out error of the SDF's probe.
    """
    if not wanted(*context.foreseen):
        return {}
    errors = context.probed
    hidden = context.hidden_layers(errors, context.budget.scale)
    return context.fit(context.tasks(hidden, errors), context.listen)


def fit_to_size(
    context: FitContext,
    size: float,
    document: Callable[[Networks], Document],
    wanted: Callable[[float, float], bool] = lambda size, probe_error: True,
) -> Networks:
    """Networks for a file of at most `size` bytes, textures apart; `document` is its content.

    None if they are not wanted, as in `fit_with_preset`. Raises TargetSizeError, before anything is
    trained, when the size is too small for the asset's tables and the smallest networks.
    """
    besides, least = _least_bytes(context.problem, document)
    if size < least:
        raise TargetSizeError(math.ceil(least), size)
    if not wanted(size, context.probed["sdf"]):
        return {}
    tasks = context.tasks(_hidden_for(context, size - besides), context.probed)
    floats = context.fit([replace(task, quantization=None) for task in tasks], context.listen)
    fitted = [replace(task, fitted=floats[task.name]) for task in tasks]

    def rounded(octaves: float) -> tuple[Networks, int]:
        networks = context.fit([_coarser(task, octaves) for task in fitted], context.listen)
        return networks, _bytes(document(networks), TXTR)

    weights = sum(task.spec.weight_count for task in tasks)
    return _rounded_to(size, rounded, weights, context.problem.config.target)


def _coarser(task: Task, octaves: float) -> Task:
    assert task.quantization is not None
    return replace(task, quantization=replace(task.quantization, coarser=octaves))


def _rounded_to(
    size: float,
    rounded: Callable[[float], tuple[Networks, int]],
    weights: int,
    config: TargetConfig,
) -> Networks:
    """The networks of the most bytes up to `size` of those tried, all rounded alike.

    `rounded` says networks and bytes for octaves by which they are rounded more coarsely. Raises
    TargetSizeError where none is small enough.
    """
    octaves, tried = 0.0, list[tuple[float, int]]()
    best, most = Networks(), 0
    for _ in range(config.roundings):
        networks, found = rounded(octaves)
        tried.append((octaves, found))
        if most < found <= size:
            best, most = networks, found
        if config.enough * size <= found <= size:
            break
        octaves = _next_octaves(tried, size, weights, config)
    if not best:
        raise TargetSizeError(min(found for _, found in tried), size)
    return best


def _next_octaves(
    tried: Sequence[tuple[float, int]], size: float, weights: int, config: TargetConfig
) -> float:
    """Where bytes should be those aimed at, by the last two tries.

    Before there are two, an octave takes a bit of each weight; always a byte at least.
    """
    last, found = tried[-1]
    fall = weights / 8
    if len(tried) > 1:
        before, more = tried[-2]
        fall = max((more - found) / (last - before), 1.0)
    wanted = last + (found - config.aim * size) / fall
    large = max((each for each, found in tried if found > size), default=-config.farthest)
    small = min((each for each, found in tried if found <= size), default=config.farthest)
    return wanted if large < wanted < small else (large + small) / 2


def _least_bytes(
    problem: AssetProblem, document: Callable[[Networks], Document]
) -> tuple[int, float]:
    """Of a file with the smallest networks: what is not networks, and all of it."""
    sizing = problem.config.sizing
    tiny = problem.specs(smallest(problem.networks, sizing))
    blank = {name: blank_network(spec) for name, spec in tiny.items()}
    besides = _bytes(document(blank), NETS, TXTR)
    return besides, besides + bytes_of(tiny, sizing)


def _hidden_for(context: FitContext, room: float) -> Hidden:
    """Hidden layers whose networks should take so many bytes."""
    problem, errors, sizing = context.problem, context.probed, context.problem.config.sizing
    scale = scale_for_bytes(
        lambda scale: bytes_of(problem.specs(context.hidden_layers(errors, scale)), sizing), room
    )
    return context.hidden_layers(errors, scale)


def fit_to_error(context: FitContext, wanted: float) -> Networks:
    """Networks whose SDF has a mean held-out error of `wanted`, within `TargetConfig.close`.

    Raises NispError for less than `TargetConfig.least_error`, FitError when no width comes close
    enough; an asset whose smallest network is already better is not made worse.
    """
    config = context.problem.config.target
    if wanted < config.least_error:
        raise NispError(f"target error: expected at least {config.least_error:g}, found {wanted:g}")
    errors = context.probed
    hidden = dict(context.hidden_layers(errors, context.budget.scale))
    networks: Networks = {}
    tried: dict[int, float] = {}
    for _ in range(config.rounds):
        networks.pop("sdf", None)
        tasks = [task for task in context.tasks(hidden, errors) if task.name not in networks]
        networks |= context.fit(tasks, context.listen)
        used = hidden["sdf"][0]
        tried[used] = error = _distance_error(context.problem, networks["sdf"])
        note = f"sdf of width {used}: mean distance {error:.3g}, asked {wanted:.3g}"
        context.listen(Progress(network="sdf", stage="fit", note=note))
        width = _next_width(tried, wanted, config)
        if abs(error / wanted - 1) <= config.close or width in tried:
            break
        hidden["sdf"] = layers(width, len(hidden["sdf"]), context.problem.config.sizing)
    if error > (1 + config.close) * wanted:
        raise FitError(
            f"target error: expected {wanted:g} within {config.close:.0%}, found {error:.3g} with "
            f"an SDF of width {used}; a preset that takes longer may do better"
        )
    return networks


def blank_network(spec: NetworkSpec) -> Network:
    """A network whose weights are all 0."""
    return Network(spec, {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()})


def _bytes(document: Document, *left_out: str) -> int:
    """Of a file, without the sections of these codes."""
    data = pack(document)
    return len(data) - sum(
        section.stored_length for section in inspect(data) if section.code in left_out
    )


def _next_width(tried: Mapping[int, float], wanted: float, config: TargetConfig) -> int:
    """Where a power law through the two best fits, or the usual one, meets the wanted error."""
    order = sorted(tried, key=lambda width: abs(math.log(tried[width] / wanted)))
    slope, best = config.slope, order[0]
    if len(order) > 1:
        measured = math.log(tried[order[1]] / tried[best]) / math.log(best / order[1])
        low, high = config.slopes
        slope = min(max(measured, low), high)
    return even_width(best * (tried[best] / wanted) ** (1 / slope))


def _distance_error(problem: AssetProblem, network: Network) -> float:
    held_out = problem.sets.held_out_distance
    return float(np.abs(evaluate(network, held_out.points)[:, 0] - held_out.sdf).mean())
