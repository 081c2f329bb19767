"""From an analyzed and sampled asset to its networks, on this machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from nispcodec.core.cores import cores
from nispcodec.core.document import Document
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.targets import (
    FitContext,
    fit_to_error,
    fit_to_size,
    fit_with_preset,
    pruned,
)
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.triangles import area
from nispcodec.train.backend.protocol import Engine
from nispcodec.train.config import TrainConfig
from nispcodec.train.task import Task
from nispcodec.train.tasks import AssetProblem, paper_tasks
from nispcodec.train.workers import fit_networks


def fit(
    analysis: Analysis,
    sets: TrainingSets,
    config: EncodeConfig,
    training: TrainConfig,
    engine: Engine,
    document: Callable[[Mapping[str, Network]], Document],
    wanted: Callable[[float, float], bool],
    progress: Listener,
) -> Mapping[str, Network]:
    """The networks: the published ones, or sine networks as large as the preset or target asks.

    None at all where a preset's, whose bytes and probe error are told to `wanted`, are not.
    Raises FitError when a network does not converge.
    """
    threads = cores()

    def run(tasks: list[Task], listen: Listener) -> dict[str, Network]:
        return fit_networks(tasks, config.seed, engine, threads, listen)

    problem = asset_problem(analysis, sets, training)
    if config.preset == "paper":
        tasks = paper_tasks(problem.charts, sets, training)
        needed = [task for task in tasks if task.name in problem.networks]
        return run(pruned(needed, config.prunings()), progress)
    budget = training.budgets[config.preset]
    context = FitContext(problem, budget, run, progress, config.prunings())
    if config.target_error is not None:
        return fit_to_error(context, config.target_error)
    if config.target_size is not None:
        return fit_to_size(context, config.target_size, document)
    return fit_with_preset(context, wanted)


def asset_problem(analysis: Analysis, sets: TrainingSets, training: TrainConfig) -> AssetProblem:
    """Everything about an asset that the tasks of its networks depend on."""
    table, symmetry = analysis.table, analysis.symmetry
    return AssetProblem(
        sets,
        charts=len(table),
        has_uv=bool(table.has_uv.any()),
        area=float(area(analysis.solid.pieces).sum()),
        sdf_mirror=symmetry.sdf,
        uv_mirror=symmetry.uv,
        config=training,
    )
