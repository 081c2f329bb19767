"""What a training step takes, by the native backend and by torch, on one thread.

    python -m benchmarks.studies.training_step [--seconds 2] [--write benchmarks/results/NAME.json]

The two take turns, and the fastest turn of each counts: others on the machine make a turn longer,
never shorter. Times are of the processor. `share_of_peak` is the arithmetic of a step (network,
backwards and forwards, and Muon's products) against a loop of fused multiplications and additions
that nothing else holds up, on the same core, just before.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path

import click
import numpy as np
import torch

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, as_json, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.arrays import Float32Array, Int32Array
from nispcodec.core.network import NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.native.library import available, library
from nispcodec.train.backend.native.settings import Settings
from nispcodec.train.backend.native.trainer import NativeTrainer
from nispcodec.train.backend.torch.trainer import TorchTrainer
from nispcodec.train.config import TrainConfig
from nispcodec.train.initialization import initial_weights
from nispcodec.train.objectives import OBJECTIVES
from nispcodec.train.task import Schedule, Task

BATCH, SAMPLES, STEPS, ROUNDS = 1024, 200_000, 20, 1_000_000
NETWORKS: dict[str, tuple[NetworkSpec, str]] = {
    "sdf 4x24": (NetworkSpec((24,) * 4, 1), "sdf"),
    "sdf 5x66": (NetworkSpec((66,) * 5, 1), "sdf"),
    "charts 4x30, 40 labels": (NetworkSpec((30,) * 4, 40), "chart"),
    "uv 4x22, 40 charts": (
        NetworkSpec((22,) * 4, 2, conditioning="chart_affine", charts=40, embedding=4),
        "uv",
    ),
}


OF_TORCH = {"sdf 4x24": 0.12, "sdf 5x66": 0.4}
"""How long a step may take, against torch's."""
SHARE_OF_PEAK = {"sdf 5x66": 0.7}


@click.command()
@click.option("--seconds", default=2.0, help="That each network's turns take.")
@click.option("--write", type=click.Path(path_type=Path), help="The result file.")
def main(seconds: float, write: Path | None) -> None:
    """Measure every network on every instruction set."""
    torch.set_num_threads(1)
    found = {name: measured(*network, seconds) for name, network in NETWORKS.items()}
    where = {"commit": commit(), "machine": machine(), "versions": versions()}
    result = where | {"best": available()[0], "networks": found}
    if write:
        write_result(write, result)
    print(as_json(result))


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every network in a result file, on the best instruction set."""
    best = results["best"]

    def targets(network: str) -> Iterator[Target]:
        if network in OF_TORCH:
            yield Target("a step, of torch's", ("of_torch", best), OF_TORCH[network])
        if network in SHARE_OF_PEAK:
            place = ("share_of_peak", best)
            yield Target("share of the peak", place, SHARE_OF_PEAK[network], at_least=True)

    return asked_of_each(results["networks"], targets)


def measured(spec: NetworkSpec, loss: str, seconds: float) -> Record:
    """Milliseconds a step, by backend, and what follows from them."""
    samples = random_samples(spec)
    rows = np.random.default_rng(1).integers(0, SAMPLES, (STEPS, BATCH)).astype(np.int32)
    rates = np.full(STEPS, 1e-4, dtype=np.float32)
    runs = {"torch": torch_steps(spec, loss, samples, rows, rates)}
    runs |= {isa: native_steps(spec, loss, samples, rows, rates, isa) for isa in available()}
    best = by_turns(runs, seconds)
    peaks = {isa: peak(isa) for isa in available()}
    return {
        "milliseconds": {name: 1e3 * spent / STEPS for name, spent in best.items()},
        "of_torch": {isa: best[isa] / best["torch"] for isa in peaks},
        "share_of_peak": {
            isa: operations(spec) * STEPS / best[isa] / most for isa, most in peaks.items()
        },
    }


def by_turns(runs: dict[str, Callable[[], object]], seconds: float) -> dict[str, float]:
    """Seconds of the processor of the fastest turn of each."""
    best = dict.fromkeys(runs, np.inf)
    ends = time.monotonic() + seconds
    while time.monotonic() < ends or not np.isfinite(list(best.values())).all():
        for name, run in runs.items():
            best[name] = min(best[name], spent(run))
    return best


def spent(run: Callable[[], object]) -> float:
    """Seconds of the processor."""
    started = time.process_time()
    run()
    return time.process_time() - started


def native_steps(
    spec: NetworkSpec,
    loss: str,
    samples: SampleSet,
    rows: Int32Array,
    rates: Float32Array,
    isa: str,
) -> Callable[[], object]:
    """Steps of the kernel for an instruction set."""
    settings = Settings.of(TrainConfig(), 0.01, 1.0, 0.01)
    trainer = NativeTrainer(spec, samples, loss, initial_weights(spec), None, settings, isa=isa)
    return lambda: trainer.steps(rows, rates)


def torch_steps(
    spec: NetworkSpec, loss: str, samples: SampleSet, rows: Int32Array, rates: Float32Array
) -> Callable[[], object]:
    """The same steps of torch."""
    objective = OBJECTIVES[loss](TrainConfig().loss)
    task = Task(loss, spec, samples, samples, objective, Schedule(STEPS))
    trainer = TorchTrainer(task, initial_weights(spec), None, "cpu")
    return lambda: trainer.steps(rows, rates)


def peak(isa: str) -> float:
    """Operations a second, a multiplication and an addition being two; the best of a few loops."""
    loop = library(isa).functions.nisp_peak
    return max(2 * loop(ROUNDS) / spent(lambda: loop(ROUNDS)) for _ in range(10))


def operations(spec: NetworkSpec) -> float:
    """Of a step: the layers' products three times, twice for the first, and Muon's products."""
    layers = list(pairwise((spec.inputs, *spec.hidden, spec.outputs)))
    weights = [fan_in * fan_out for fan_in, fan_out in layers]
    network = 2 * BATCH * (3 * sum(weights) - weights[0])
    sides = [sorted((fan_in + 1, fan_out)) for fan_in, fan_out in layers[1:-1]]
    muon = sum(2 * (2 * short * short * long + short**3) for short, long in sides)
    return network + TrainConfig().muon.rounds * muon


def random_samples(spec: NetworkSpec) -> SampleSet:
    """SAMPLES of them, about a sphere."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (SAMPLES, 3)).astype(np.float32)
    sdf = (np.linalg.norm(points, axis=1) - 0.6).astype(np.float32)
    chart = rng.integers(0, spec.charts or spec.outputs, SAMPLES).astype(np.int32)
    return SampleSet(points, sdf, chart, rng.uniform(0, 1, (SAMPLES, 2)).astype(np.float32))


if __name__ == "__main__":
    main()
