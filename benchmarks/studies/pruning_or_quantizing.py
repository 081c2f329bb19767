"""Small sine networks pruned, quantized, both, or narrower: bytes in a file and held-out error.

    python -m benchmarks.studies.pruning_or_quantizing --assets ../shared/assets [--table]

SDF and UV networks of each asset and seed: float16 and lottery tickets of it at `RATES`, rounded
at `PRICES`, and both: the tickets' masks held, and what is left rounded at `BOTH`; and networks of
`WIDTHS`, rounded as the presets do. All trainings have as many steps, and those of one width start
from the same weights. Kept case by case: an interrupted run goes on.
The default takes a quarter of an hour of one core, and leaves all networks far from what they can
reach; `--steps 4000` says more. `--table` trains nothing. In the table each setting is beside
float16, unpruned, and beside the curve of quantizing alone: bytes at the same error, below 1 where
pruning, or a narrower network, pays.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.rate_distortion.bjontegaard import front
from benchmarks.studies.codings import stored
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import silent
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.recipes import training_sets
from nispcodec.dataset.sampler import Sampler
from nispcodec.geometry.analysis import analyze
from nispcodec.infer.evaluate import evaluate
from nispcodec.io.load import load_mesh
from nispcodec.train.backend.choice import choose_engine
from nispcodec.train.config import TrainConfig
from nispcodec.train.cores import one_core
from nispcodec.train.loop import train
from nispcodec.train.lottery_ticket import lottery_ticket
from nispcodec.train.objectives import SdfObjective, UvObjective
from nispcodec.train.prune import Mask
from nispcodec.train.sizing import even_width
from nispcodec.train.task import Quantization, Schedule, Task

RESULTS = Path("benchmarks/results/pruning_or_quantizing.json")
ASSETS = ("spot", "chess_king", "tea_set_01")
NETWORKS = ("sdf", "uv")
SEEDS = 2
RATES = (0.3, 0.5, 0.7)
PRICES = (1.0, 6.0, 36.0)
BOTH = 6.0
"""Times what the presets pay for a bit."""
WIDTHS = (0.75, 0.5)
"""Of the widths of all others."""

STEPS, BATCH = 1500, 1024
SAMPLER_SEED = 0


def networks(path: Path, steps: int) -> dict[str, Task]:
    """SDF 4 x 32 and UV 3 x 24, with the samples of the default preset."""
    analysis = analyze(load_mesh(path), SAMPLER_SEED)
    sets, charts = training_sets(Sampler(analysis, SAMPLER_SEED)), len(analysis.table)
    sdf = NetworkSpec((32,) * 4, 1)
    uv = NetworkSpec((24,) * 3, 2, conditioning="chart_affine", charts=charts, embedding=4)
    distance, surface = (sets.distance, sets.held_out_distance), (sets.uvs, sets.held_out_surface)
    schedule, config = Schedule(steps, BATCH), TrainConfig().loss
    return {
        "sdf": Task("sdf", sdf, *distance, SdfObjective(config), schedule),
        "uv": Task("uv", uv, *surface, UvObjective(config), schedule),
    }


def error(network: Network, test: SampleSet) -> float:
    """Mean |f - SDF|, or mean distance in the network's UV square given the true chart."""
    if network.spec.conditioning == "none":
        return float(np.abs(evaluate(network, test.points)[:, 0] - test.sdf).mean())
    off = evaluate(network, test.points, test.chart) - test.uv
    return float(np.linalg.norm(off, axis=1).mean())


def measure(task: Task, seed: int) -> list[Record]:
    """Every setting of one network: {"rate", "price", "width", "bytes", "error"}."""
    points: list[Record] = []
    masks: dict[float, Mask] = {}
    engine = choose_engine("auto", "cpu", False, silent)

    def fitted(mask: Mask | None, price: float, width: float = 1.0) -> Network:
        preset = task.config.networks[task.name].lambda_
        quantization = Quantization(price * preset)
        hidden = tuple(even_width(width * each) for each in task.spec.hidden)
        spec = replace(task.spec, hidden=hidden)
        priced = replace(task, spec=spec, quantization=quantization if price else None)
        return train(priced, seed, engine, one_core, silent, mask)

    def add(network: Network, rate: float, price: float, width: float = 1.0) -> None:
        setting = {"rate": rate, "price": price, "width": width}
        found = {"bytes": stored(network, None), "error": error(network, task.held_out)}
        points.append({**setting, **found})
        click.echo(f"  {setting} {found}", err=True)

    def trained(mask: Mask, rate: float) -> Network:
        masks[rate] = mask
        network = fitted(mask, 0.0)
        add(halved(network), rate, 0.0)
        return network

    for _ in lottery_ticket(task, "smallest", RATES, trained):
        pass
    settings = [(0.0, price) for price in PRICES] + [(rate, BOTH) for rate in RATES]
    for rate, price in settings:
        add(fitted(masks[rate], price), rate, price)
    for width in WIDTHS:
        add(fitted(None, 1.0, width), 0.0, 1.0, width)
    return points


def halved(network: Network) -> Network:
    """The weights rounded to float16."""
    tensors = {
        name: tensor.astype(np.float16).astype(np.float32)
        for name, tensor in network.tensors.items()
    }
    return replace(network, tensors=tensors)


def run(assets: Path, seeds: int, steps: int, output: Path) -> None:
    """Measure every case that is not there with so many steps."""
    for asset in ASSETS:
        wanted = [(network, seed) for network in NETWORKS for seed in range(seeds)]
        there = {(each["network"], each["seed"]) for each in _of(_read(output), asset, steps)}
        left = [each for each in wanted if each not in there]
        tasks = networks(assets / asset / f"{asset}.obj", steps) if left else {}
        for network, seed in left:
            click.echo(f"{asset}, {network}, seed {seed}", err=True)
            case = {"asset": asset, "network": network, "seed": seed, "steps": steps}
            started = time.process_time()
            points = measure(tasks[network], seed)
            seconds = round(time.process_time() - started, 1)
            case |= {"commit": commit(), "cpu_seconds": seconds, "points": points}
            _write(output, [*_read(output), case])


def _of(cases: Sequence[Record], asset: str, steps: int) -> list[Record]:
    return [each for each in cases if (each["asset"], each["steps"]) == (asset, steps)]


def _read(path: Path) -> list[Record]:
    cases: list[Record] = result_so_far(path).get("cases", [])
    return cases


def _write(path: Path, cases: list[Record]) -> None:
    how = {"machine": machine(), "versions": versions(), "batch": BATCH}
    write_result(path, {**how, "cases": cases})


def against_quantized(case: Record, point: Record) -> float:
    """Bytes of a point relative to quantizing alone at the same error; NaN out of its reach."""
    alone = [
        (each["bytes"], each["error"])
        for each in case["points"]
        if (each["rate"], each["width"]) == (0, 1)
    ]
    curve = front(alone)[::-1]
    sizes, errors = np.log(curve).T
    same = np.interp(np.log(point["error"]), errors, sizes, left=np.nan, right=np.nan)
    return float(point["bytes"] / np.exp(same))


def table(cases: Sequence[Record]) -> Iterator[str]:
    """Markdown: geometric means over the cases of each network."""
    columns = "network", "pruned", "width", "price", "bytes", "error / float16"
    yield f"| {' | '.join(columns)} | bytes / quantized alone | cases |"
    yield "|---|---|---|---|---|---|---|---|"
    for network in NETWORKS:
        alike = [case for case in cases if case["network"] == network]
        for index in range(len(alike[0]["points"]) if alike else 0):
            yield _row(network, alike, index)


def _row(network: str, cases: Sequence[Record], index: int) -> str:
    points = [case["points"][index] for case in cases]
    worse = [
        point["error"] / case["points"][0]["error"]
        for case, point in zip(cases, points, strict=True)
    ]
    ratios = [against_quantized(*pair) for pair in zip(cases, points, strict=True)]
    reached = [ratio for ratio in ratios if np.isfinite(ratio)]
    beside = f"{_mean(reached):.2f} ({len(reached)})" if reached else "-"
    size, price = _mean([point["bytes"] for point in points]), points[0]["price"]
    return (
        f"| {network} | {points[0]['rate']:.0%} | {points[0]['width']:.0%} | {price or 'float16'} "
        f"| {size:,.0f} | {_mean(worse):.2f} | {beside} | {len(cases)} |"
    )


def _mean(values: Sequence[float]) -> float:
    return float(np.exp(np.mean(np.log(values))))


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), default="../shared/assets")
@click.option("--seeds", type=click.IntRange(1), default=SEEDS, show_default=True)
@click.option("--steps", type=click.IntRange(1), default=STEPS, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
@click.option("--table", "only_table", is_flag=True, help="Train nothing.")
def main(assets: Path, seeds: int, steps: int, output: Path, only_table: bool) -> None:
    """Run what is missing, on one core; print the table."""
    if not only_table:
        run(assets, seeds, steps, output)
    cases = [case for case in _read(output) if case["steps"] == steps]
    click.echo("\n".join(table(cases)))


if __name__ == "__main__":
    main()
