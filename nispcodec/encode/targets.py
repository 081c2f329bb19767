"""How good or how small: fits an asset's networks with a preset, to a size, or to an error."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from nispcodec.core.document import Document
from nispcodec.core.errors import FitError, NispError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Listener, Progress
from nispcodec.format import inspect, pack
from nispcodec.format.constants import NETS, TXTR
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.presets import Effort, Problem, probes, sine_tasks
from nispcodec.train.prune import Pruning
from nispcodec.train.sizing import (
    Hidden,
    bits_of,
    bytes_of,
    even_width,
    hidden_layers,
    layers,
    scale_for_bytes,
    smallest,
)
from nispcodec.train.task import Task

Networks = dict[str, Network]
Fit = Callable[[list[Task], Listener], Networks]

CLOSE = 0.1
"""How far, relative to it, from an error that was asked for is near enough."""

SLOPE, SLOPES = 0.7, (0.3, 1.5)
"""The error falls with this power of the SDF's width, until two fits tell better."""

ROUNDS = 5
LEAST_ERROR = 2e-5
"""Samples, float32 and the extracted mesh are good for no less (normalized frame)."""


@dataclass(frozen=True)
class Fitting:
    """An asset's problem, how much effort it is worth, what is pruned, and what runs tasks."""

    problem: Problem
    effort: Effort
    fit: Fit
    listen: Listener
    prunings: Mapping[str, Pruning] = field(default_factory=dict)

    def probe(self) -> dict[str, float]:
        """The held-out errors of the probes, by name."""
        errors: dict[str, float] = {}

        def heard(progress: Progress) -> None:
            errors[progress.network] = progress.error
            self.listen(Progress(stage="probe how much there is to learn"))

        self.fit(probes(self.problem), heard)
        return errors

    def tasks(
        self, hidden: Hidden, errors: Mapping[str, float], budgets: Mapping[str, float]
    ) -> list[Task]:
        """The tasks for networks with these hidden layers."""
        tasks = sine_tasks(self.problem, hidden, self.effort, errors, budgets)
        return pruned(tasks, self.prunings)


def pruned(tasks: list[Task], prunings: Mapping[str, Pruning]) -> list[Task]:
    """The tasks, with each network's pruning."""
    return [replace(task, pruning=prunings.get(task.name)) for task in tasks]


def fit_with_preset(fitting: Fitting) -> Networks:
    """Networks as large as the preset and the asset suggest."""
    errors = fitting.probe()
    hidden = hidden_layers(errors, fitting.problem.area, fitting.effort.scale)
    return fitting.fit(fitting.tasks(hidden, errors, {}), fitting.listen)


def fit_to_size(
    fitting: Fitting, wanted: float, document: Callable[[Networks], Document]
) -> Networks:
    """Networks for a file of `wanted` bytes, textures apart; `document` is the file's content.

    Raises NispError, before anything is trained, when that is too few for the asset.
    """
    problem = fitting.problem
    tiny = problem.specs(smallest(problem.networks))
    besides = _bytes_besides(document({name: _blank(spec) for name, spec in tiny.items()}))
    least = besides + bytes_of(tiny)
    if wanted < least:
        raise NispError(
            f"target size: expected at least {least:,.0f} bytes for this asset (its tables and the "
            f"smallest networks), found {wanted:,.0f}"
        )
    errors = fitting.probe()
    scale = scale_for_bytes(
        lambda scale: bytes_of(problem.specs(hidden_layers(errors, problem.area, scale))),
        wanted - besides,
    )
    hidden = hidden_layers(errors, problem.area, scale)
    specs = problem.specs(hidden)
    share = (wanted - besides) / bytes_of(specs)
    budgets = {name: share * bits for name, bits in bits_of(specs).items()}
    return fitting.fit(fitting.tasks(hidden, errors, budgets), fitting.listen)


def fit_to_error(fitting: Fitting, wanted: float) -> Networks:
    """Networks whose SDF has a mean held-out error of `wanted`, within `CLOSE`.

    Raises NispError for less than `LEAST_ERROR`, FitError when no width comes close enough; an
    asset whose smallest network is already better is not made worse.
    """
    if wanted < LEAST_ERROR:
        raise NispError(f"target error: expected at least {LEAST_ERROR:g}, found {wanted:g}")
    errors = fitting.probe()
    hidden = dict(hidden_layers(errors, fitting.problem.area, fitting.effort.scale))
    networks: Networks = {}
    tried: dict[int, float] = {}
    for _ in range(ROUNDS):
        tasks = [task for task in fitting.tasks(hidden, errors, {}) if task.name not in networks]
        networks |= fitting.fit(tasks, fitting.listen)
        used = hidden["sdf"][0]
        tried[used] = error = _distance_error(fitting.problem, networks["sdf"])
        note = f"sdf of width {used}: mean distance {error:.3g}, asked {wanted:.3g}"
        fitting.listen(Progress(network="sdf", stage="fit", note=note))
        width = _next_width(tried, wanted)
        if abs(error / wanted - 1) <= CLOSE or width in tried:
            break
        del networks["sdf"]
        hidden["sdf"] = layers(width, len(hidden["sdf"]))
    if error > (1 + CLOSE) * wanted:
        raise FitError(
            f"target error: expected {wanted:g} within {CLOSE:.0%}, found {error:.3g} with an SDF "
            f"of width {used}; a preset that takes longer may do better"
        )
    return networks


def _blank(spec: NetworkSpec) -> Network:
    return Network(spec, {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()})


def _bytes_besides(document: Document) -> int:
    """Of a file without its textures, what is not networks."""
    data = pack(document)
    return len(data) - sum(
        section.stored_length for section in inspect(data) if section.code in (NETS, TXTR)
    )


def _next_width(tried: Mapping[int, float], wanted: float) -> int:
    """Where a power law through the two best fits, or the usual one, meets the wanted error."""
    order = sorted(tried, key=lambda width: abs(math.log(tried[width] / wanted)))
    slope, best = SLOPE, order[0]
    if len(order) > 1:
        measured = math.log(tried[order[1]] / tried[best]) / math.log(best / order[1])
        slope = min(max(measured, SLOPES[0]), SLOPES[1])
    return even_width(best * (tried[best] / wanted) ** (1 / slope))


def _distance_error(problem: Problem, network: Network) -> float:
    held_out = problem.sets.held_distance
    return float(np.abs(evaluate(network, held_out.points)[:, 0] - held_out.sdf).mean())
