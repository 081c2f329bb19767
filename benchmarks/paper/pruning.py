"""The paper's pruning figure and its table of sizes, on our assets with the paper's networks.

    python -m benchmarks.paper.pruning --assets ../shared/assets [--draw]

One series for each asset and strategy: unpruned, then ten rounds that prune, rewind and retrain; an
interrupted run goes on with the first series that is not in the JSON. `--draw` trains nothing: it
draws the figure and prints the tables of what is there.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import click
import numpy as np
import torch

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.paper.pruning_figure import draw, tables
from benchmarks.paper.pruning_published import RATES, SIZED, SIZES
from benchmarks.studies.codings import stored
from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import Network
from nispcodec.core.progress import silent
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.analysis import analyze
from nispcodec.geometry.config import GeometryConfig
from nispcodec.infer.evaluate import evaluate
from nispcodec.io.load import load_mesh
from nispcodec.train.backend.torch.engine import TorchEngine
from nispcodec.train.config import TrainConfig
from nispcodec.train.cores import one_core
from nispcodec.train.loop import train
from nispcodec.train.lottery_ticket import lottery_ticket
from nispcodec.train.objectives import UvObjective
from nispcodec.train.prune import STRATEGIES, Mask
from nispcodec.train.task import Task
from nispcodec.train.tasks import paper_tasks

RESULTS, FIGURE = Path("benchmarks/results/pruning.json"), Path("docs/pruning.png")
ASSETS = ("spot", "chess_king")
SEED = 0
STEPS, BATCH = 1500, 512
SAMPLES, TEST = 200_000, 10_000


class AbsoluteUv(UvObjective):
    """Judged by the paper's loss."""

    def error(self, outputs: Float32Array, samples: SampleSet) -> float:
        """Mean absolute error of u and v."""
        return self.loss(outputs, samples)


def paper_networks(path: Path, steps: int) -> list[Task]:
    """The chart and the UV network with the paper's losses, optimizer and rates."""
    analysis = analyze(load_mesh(path), SEED, GeometryConfig(merging=None))
    sampler = Sampler(analysis, SEED)
    samples, surface = sampler.importance(SAMPLES), sampler.surface(TEST)
    near = sampler.near_surface(1, SamplingConfig.uv_spread)
    sets = TrainingSets(samples, samples, samples, near, surface, samples[:0])
    _, chart, uv = paper_tasks(len(analysis.table), sets, TrainConfig())
    schedule = replace(chart.schedule, steps=steps, batch=BATCH)
    judged = AbsoluteUv(TrainConfig().loss)
    return [replace(chart, schedule=schedule), replace(uv, schedule=schedule, objective=judged)]


def quality(network: Network, test: SampleSet) -> float:
    """Chart accuracy, or mean absolute error of u and v given the true chart, on the surface."""
    if network.spec.conditioning == "none":
        return float((evaluate(network, test.points).argmax(axis=1) == test.chart).mean())
    return float(np.abs(evaluate(network, test.points, test.chart) - test.uv).mean())


def series(task: Task, strategy: str) -> list[Record]:
    """A round for every rate, 0 first."""
    rounds: list[Record] = []

    def trained(mask: Mask, rate: float) -> Network:
        network = train(task, SEED, TorchEngine("cpu"), one_core, silent, mask)
        found = quality(network, task.held_out)
        rounds.append({"rate": rate, "quality": found, "kept": _kept(mask)})
        if strategy == "smallest" and rate in (0.0, SIZED[task.name]):
            rounds[-1]["bytes"] = {coding: stored(network, coding) for coding in SIZES[task.name]}
        click.echo(f"  {task.name} {strategy} {rate:.2%}: {found:.5f}", err=True)
        return network

    for _ in lottery_ticket(task, strategy, RATES, trained):
        pass
    return rounds


def _kept(mask: Mask) -> int:
    return sum(int(kept.sum()) for kept in mask.values())


def missing(record: Record, steps: int) -> list[tuple[str, str]]:
    """Assets and strategies whose series is not there with so many steps."""
    there = {(each["asset"], each["strategy"], each["steps"]) for each in record["series"]}
    wanted = [(asset, strategy) for asset in ASSETS for strategy in STRATEGIES]
    return [each for each in wanted if (*each, steps) not in there]


def measure(asset: str, strategy: str, tasks: Sequence[Task], steps: int) -> Record:
    """Both networks of an asset at all rates by one strategy."""
    started = time.process_time()
    return {
        "asset": asset,
        "strategy": strategy,
        "steps": steps,
        "commit": commit(),
        "weights": {task.name: task.spec.weight_count for task in tasks},
        "rounds": {task.name: series(task, strategy) for task in tasks},
        "cpu_seconds": round(time.process_time() - started, 1),
    }


def run(assets: Path, steps: int, output: Path, figure: Path) -> None:
    """Measure what is missing; keep JSON and figure up to date."""
    tasks: dict[str, list[Task]] = {}
    for asset, strategy in missing(_read(output), steps):
        if asset not in tasks:
            click.echo(f"{asset}: samples", err=True)
            tasks = {asset: paper_networks(assets / asset / f"{asset}.obj", steps)}
        found = measure(asset, strategy, tasks[asset], steps)
        others = [
            each
            for each in _read(output)["series"]
            if (each["asset"], each["strategy"]) != (asset, strategy)
        ]
        _write(output, [*others, found])
        draw([*others, found], figure)


def _read(path: Path) -> Record:
    return {"series": [], **result_so_far(path)}


def _write(path: Path, found: list[Record]) -> None:
    order = [(asset, strategy) for asset in ASSETS for strategy in STRATEGIES]
    found.sort(key=lambda each: order.index((each["asset"], each["strategy"])))
    how = {
        "batch": BATCH,
        "samples": SAMPLES,
        "importance": SamplingConfig.beta,
        "test": TEST,
        "seed": SEED,
        "published": "2000 epochs of 10^6 samples, batches of 2048: 976,562 steps",
    }
    record = {"machine": machine(), "versions": versions(), "how": how, "series": found}
    write_result(path, record)


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), default="../shared/assets")
@click.option("--steps", type=click.IntRange(1), default=STEPS, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
@click.option("--figure", type=click.Path(path_type=Path), default=FIGURE, show_default=True)
@click.option("--draw", "only_draw", is_flag=True, help="Train nothing.")
def main(assets: Path, steps: int, output: Path, figure: Path, only_draw: bool) -> None:
    """Run what is missing, on one core; draw the figure; print the tables."""
    torch.set_num_threads(1)
    if not only_draw:
        run(assets, steps, output, figure)
    found = _read(output)["series"]
    draw(found, figure)
    click.echo(tables(found))


if __name__ == "__main__":
    main()
