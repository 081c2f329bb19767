"""The loop: it learns, keeps its best, survives divergence, stops when told, repeats exactly."""

from __future__ import annotations

import math
import multiprocessing
import os
import select
import threading
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import torch
from torch import Tensor

from nispcodec.core.errors import FitError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Progress, silent
from nispcodec.core.sample_set import SampleSet
from nispcodec.infer.evaluate import evaluate
from nispcodec.train import workers as parallel
from nispcodec.train.backend.torch.module import Module, snapped
from nispcodec.train.backend.torch.muon import Muon, orthogonal
from nispcodec.train.backend.torch.soap import Soap
from nispcodec.train.batch import Batch
from nispcodec.train.config import LossConfig, QuantizeConfig, TrainConfig
from nispcodec.train.loop import train
from nispcodec.train.objectives import ChartObjective, SdfObjective
from nispcodec.train.task import Quantization, Schedule, Task
from nispcodec.train.workers import fit_networks, resolve_device

SDF = SdfObjective(LossConfig())
FINE = 2.0**-24
"""A step that nobody sees."""


def ball_samples(count: int, seed: int) -> SampleSet:
    """Distances to a ball of radius 1/2, its two halves as charts."""
    points = np.random.default_rng(seed).uniform(-1, 1, (count, 3)).astype(np.float32)
    sdf = np.linalg.norm(points, axis=1) - np.float32(0.5)
    return SampleSet(points, sdf, (points[:, 0] > 0).astype(np.int32), points[:, :2])


def sdf_task(steps: int = 300, rate: float = 1e-3, optimizer: str = "muon") -> Task:
    spec = NetworkSpec((16, 16), 1, w0=5.0)
    schedule = Schedule(steps, 256, rate, optimizer)
    samples = ball_samples(4000, 0), ball_samples(500, 1)
    return Task("sdf", spec, *samples, SDF, schedule)


def chart_task() -> Task:
    objective = ChartObjective(LossConfig())
    return replace(sdf_task(), name="chart", spec=NetworkSpec((8,), 2), objective=objective)


def judged_by(task: Task, error: Callable[[Module, Batch], Tensor]) -> Task:
    """The task with another held-out error."""
    kind = type("Judged", (type(task.objective),), {"error": staticmethod(error)})
    return replace(task, objective=kind(LossConfig()))


def run(task: Task, listen: Callable[[Progress], None] = silent, seed: int = 0) -> Network:
    return train(task, seed, "cpu", threading.Lock(), listen)


def module_of(network: Network) -> Module:
    """The torch side of a stored network."""
    module = Module(network.spec, "cpu")
    scaled = [tensor * module.scales[name] for name, tensor in network.tensors.items()]
    vector = np.concatenate([tensor.ravel() for tensor in scaled])
    module.weights.data = torch.from_numpy(vector.astype(np.float32))
    return module


@pytest.mark.parametrize("optimizer", ["muon", "adam"])
def test_it_learns_a_ball(optimizer: str) -> None:
    seen: list[Progress] = []
    run(sdf_task(rate=3e-3, optimizer=optimizer), seen.append)
    assert seen[-1].error < 0.07
    assert seen[-1].error < seen[0].error
    assert (seen[-1].step, seen[-1].steps, seen[-1].seconds_left) == (300, 300, 0)


def test_the_returned_weights_are_the_best_seen() -> None:
    seen: list[float] = []
    task = sdf_task()

    def noted(module: Module, batch: Batch) -> Tensor:
        error = SDF.error(module, batch).detach()
        seen.append(float(error))
        return error

    network = run(judged_by(task, noted))
    final = float(SDF.error(module_of(network), Batch.of(task.held_out, "cpu")).detach())
    assert final == pytest.approx(min(seen), rel=1e-3)


def test_divergence_is_noticed_told_and_survived() -> None:
    """The held-out error is made to explode once, in the middle."""
    calls = {"count": 0}

    def explodes(module: Module, batch: Batch) -> Tensor:
        calls["count"] += 1
        error = SDF.error(module, batch)
        return error * float("nan") if calls["count"] == 6 else error

    notes: list[str] = []
    task = judged_by(sdf_task(), explodes)
    network = run(task, lambda progress: notes.append(progress.note))
    told = [note for note in notes if note]
    assert len(told) == 1
    assert "diverged" in told[0]
    assert "0.0005" in told[0]
    assert all(np.isfinite(tensor).all() for tensor in network.tensors.values())


def test_a_hopeless_fit_is_an_error() -> None:
    task = judged_by(sdf_task(), lambda module, batch: torch.tensor(float("nan")))
    with pytest.raises(FitError, match=r"sdf network.*does not converge"):
        run(task)


def test_the_same_seed_gives_the_same_weights_on_any_number_of_threads() -> None:
    tasks = [sdf_task(100), chart_task()]
    results = [
        fit_networks(tasks, seed, "cpu", threads, silent)
        for seed, threads in ((0, 1), (0, 2), (1, 2))
    ]
    weights = [result["sdf"].tensors["weight.1"] for result in results]
    assert np.array_equal(weights[0], weights[1])
    assert not np.array_equal(weights[0], weights[2])


def test_a_core_that_the_first_leaves_is_for_the_others() -> None:
    """Both wait for each other in the middle of a step, so both need a core at that moment."""
    meeting = multiprocessing.get_context("fork").Barrier(2, timeout=30)

    def meets(module: Module, batch: Batch) -> torch.Tensor:
        meeting.wait()
        return SDF.error(module, batch)

    kind = type("Meeting", (SdfObjective,), {"loss": staticmethod(meets)})
    waiting = replace(sdf_task(1), objective=kind(LossConfig()))
    others = [replace(waiting, name=name) for name in ("one", "two")]
    found = fit_networks([sdf_task(1), *others], 0, "cpu", 2, silent)
    assert set(found) == {"sdf", "one", "two"}


def test_processes_that_start_afresh_give_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """As on other systems than Linux, and for CUDA."""
    tasks = [sdf_task(50), chart_task()]
    forked = fit_networks(tasks, 0, "cpu", 2, silent)
    monkeypatch.setattr(parallel, "_context", lambda device: multiprocessing.get_context("spawn"))
    fresh = fit_networks(tasks, 0, "cpu", 2, silent)
    assert np.array_equal(forked["sdf"].tensors["weight.1"], fresh["sdf"].tensors["weight.1"])


def test_an_interrupt_stops_every_network() -> None:
    steps: dict[str, int] = {}

    def interrupted(progress: Progress) -> None:
        steps[progress.network] = progress.step
        if progress.network == "sdf" and progress.step >= 50:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fit_networks([sdf_task(), chart_task()], 0, "cpu", 2, interrupted)
    assert max(steps.values()) < 300
    assert not multiprocessing.active_children()


def test_an_error_in_one_network_is_the_error_of_all() -> None:
    hopeless = judged_by(chart_task(), lambda module, batch: torch.tensor(float("nan")))
    with pytest.raises(FitError, match=r"chart network.*does not converge"):
        fit_networks([sdf_task(100_000), hopeless], 0, "cpu", 2, silent)
    assert not multiprocessing.active_children()


def test_a_process_that_is_killed_is_an_error() -> None:
    killed = judged_by(chart_task(), lambda module, batch: os._exit(9))
    with pytest.raises(FitError, match="chart network: its process ended with code 9"):
        fit_networks([sdf_task(), killed], 0, "cpu", 2, silent)


def test_no_process_outlives_the_one_that_started_it() -> None:
    """All hold the writing end of a pipe: who reads sees the last of them end."""
    reader, writer = os.pipe()
    fitted = ([sdf_task(10**6), chart_task()], 0, "cpu", 2, lambda _: os.write(writer, b"."))
    starter = multiprocessing.get_context("fork").Process(target=fit_networks, args=fitted)
    starter.start()
    os.close(writer)
    assert os.read(reader, 1) == b"."
    starter.kill()
    starter.join()
    while select.select([reader], [], [], 30.0)[0]:
        if not os.read(reader, 4096):
            break
    else:
        pytest.fail("a network is still being fitted after half a minute")
    os.close(reader)


@pytest.mark.parametrize("device", ["gpu", "mps", "cuda:99x", ""])
def test_a_device_that_is_not_there_is_an_error(device: str) -> None:
    if torch.cuda.is_available() and device.startswith("cuda"):
        pytest.skip("this machine has CUDA")
    with pytest.raises(FitError, match="device"):
        resolve_device(device)


@pytest.mark.parametrize(
    ("kind", "rate", "decades"), [(Soap, 0.05, 3), (partial(Muon, share=0.1), 0.5, 1)]
)
def test_matrices_find_the_minimum_of_a_badly_scaled_quadratic(
    kind: Callable[..., Soap | Muon], rate: float, decades: int
) -> None:
    """Two matrices of one shape and one of another, in no order: all are moved together."""
    torch.manual_seed(0)
    first, second, third = torch.split(torch.arange(54), [24, 24, 6])
    matrices = [(second.view(4, 6), 1.0), (first.view(4, 6), 1.0), (third.view(3, 2), 0.5)]
    target = torch.randn(54)
    scales = torch.cat([torch.logspace(-decades, 0, 6).repeat(8), torch.ones(6)])
    weights = torch.zeros(54, requires_grad=True)
    optimizer = kind(weights, matrices)
    for step in range(600):
        weights.grad = (weights.detach() - target) * scales**2
        optimizer.step(rate * (1 - step / 600))
    assert torch.allclose(weights, target, atol=0.02)


@pytest.mark.parametrize("shape", [(4, 6), (6, 4), (5, 5)])
def test_orthogonal_leaves_the_directions_and_evens_the_singular_values(
    shape: tuple[int, int],
) -> None:
    torch.manual_seed(0)
    left, _, right = torch.linalg.svd(torch.randn(3, *shape), full_matrices=False)
    values = torch.logspace(-1, 1, 3 * min(shape)).view(3, -1)
    found = orthogonal(left @ torch.diag_embed(values) @ right)
    inner = left.mT @ found @ right.mT
    even = inner.diagonal(dim1=1, dim2=2)
    assert torch.all((even > 0.6) & (even < 1.3))
    assert torch.allclose(inner, torch.diag_embed(even), atol=1e-3)


def test_mining_brings_back_a_part_that_few_samples_show() -> None:
    """Of 8000 samples eight lie in the small ball."""

    def small(points: np.ndarray) -> np.ndarray:
        return np.linalg.norm(points - [0.75, 0, 0], axis=1).astype(np.float32) - np.float32(0.13)

    def two_balls(count: int, seed: int) -> SampleSet:
        samples = ball_samples(count, seed)
        return replace(samples, sdf=np.minimum(samples.sdf, small(samples.points)))

    def share_found(minings: int) -> float:
        schedule = replace(task.schedule, minings=minings)
        network = run(replace(task, schedule=schedule))
        points = task.samples.points[small(task.samples.points) < 0]
        return float((evaluate(network, points)[:, 0] < 0).mean())

    task = replace(
        sdf_task(400, 3e-3),
        spec=NetworkSpec((16, 16), 1, w0=12.0),
        samples=two_balls(8000, 0),
        held_out=two_balls(500, 1),
    )
    assert share_found(minings=4) > 0.5 > share_found(minings=0)


@pytest.mark.parametrize(
    ("spoils", "kept", "slight", "notable"),
    [
        ([2.0, 0.5, 1.0], 0.5, 1.05, None),
        ([0.0], 0.0, 1.05, None),
        ([2.0], 2.0, math.inf, None),
        ([2.0, 0.5, 1.0], 0.5, math.inf, 1.15),
        ([2.0], 2.0, 1.05, math.inf),
    ],
)
def test_rounding_that_costs_much_is_tried_again_and_the_best_stays(
    spoils: list[float],
    kept: float,
    slight: float,
    notable: float | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As many times as there are `spoils`, each from the best weights; `notable`: as if large."""
    untried = list(spoils)
    config = QuantizeConfig(slight=slight)
    if notable is not None:
        config = replace(config, large=0, notable=notable)

    def spoiled(module: Module, *_: object) -> None:
        with torch.no_grad():
            module.weights.add_(untried.pop(0))
        scales = module.scales.values()
        module.steps = torch.tensor([snapped(FINE / scale) * scale for scale in scales])

    monkeypatch.setattr("nispcodec.train.loop.round_weights", spoiled)
    plain = module_of(run(sdf_task())).weights
    training = TrainConfig(quantize=config)
    task = replace(sdf_task(), quantization=Quantization(1e-3), config=training)
    rounded = module_of(run(task)).weights
    assert untried == []
    assert float((rounded - plain - kept).detach().abs().max()) < 1e-5
