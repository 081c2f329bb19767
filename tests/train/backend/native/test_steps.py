from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array
from tests.train.backend.native.reference import (
    CASES,
    TorchTrainer,
    native,
    relative,
    rows,
    some_weights,
)

STEPS, RATE = 10, 1e-3
# Rounding differs by 1e-6 after ten steps; what the first bases leave open, Adam's division by its
# root makes larger, where hardly any gradient is.
TOLERANCE = 2e-4
# These have directions without any gradient (the logits of two charts are each other's opposites;
# one chart's table is one row), where Adam divides one rounding error by another; torch' own
# gradients are off by 4e-6 there.
LOOSE = {"two charts, mirrored": 5e-3, "uv, one chart": 5e-2}


def moved(
    name: str, kept: Float32Array | None = None, isa: str | None = None
) -> tuple[float, float]:
    """How far weights and mean are from torch's after some steps, relative to how far they went."""
    chosen = rows(3000, 256, STEPS)
    ours, torch = native(name, isa, kept), TorchTrainer(name, kept)
    start = ours.weights
    losses = ours.steps(chosen, np.full(STEPS, RATE, np.float32))
    wanted = [torch.step(each, RATE) for each in chosen]
    assert losses == pytest.approx(wanted, rel=1e-5)
    weights = relative(ours.weights - start, torch.weights - start)
    return weights, relative(ours.mean - start, torch.mean.numpy() - start)


@pytest.mark.parametrize("name", CASES)
def test_ten_steps_lead_where_those_of_torch_lead(name: str) -> None:
    weights, mean = moved(name)
    assert weights < LOOSE.get(name, TOLERANCE)
    assert mean < LOOSE.get(name, TOLERANCE)


def test_ten_steps_on_every_instruction_set(isa: str) -> None:
    assert max(moved("sdf", isa=isa)) < TOLERANCE


def test_what_a_mask_prunes_stays_zero() -> None:
    kept = (np.random.default_rng(3).random(native("sdf").spec.weight_count) < 0.7) * 1.0
    mask = kept.astype(np.float32)
    assert max(moved("sdf", mask)) < TOLERANCE
    trainer = native("sdf", kept=mask)
    trainer.steps(rows(3000, 64, 25), np.full(25, RATE, np.float32))
    assert not trainer.weights[mask == 0].any()
    assert not trainer.mean[mask == 0].any()
    assert not trainer.gradient(rows(3000, 64)[0])[1][mask == 0].any()
    assert trainer.weights[mask == 1].all()


@pytest.mark.parametrize("name", ["sdf", "charts", "uv, 40 charts"])
def test_the_number_of_threads_changes_no_byte(name: str) -> None:
    chosen, rates = rows(3000, 1000, 30), np.full(30, RATE, np.float32)
    found = []
    for threads in (1, 2, 3):
        trainer = native(name)
        trainer.threads = threads
        losses = trainer.steps(chosen, rates)
        found.append((losses.tobytes(), trainer.weights.tobytes(), trainer.mean.tobytes()))
    assert found[0] == found[1] == found[2]


def test_the_number_of_threads_may_change_between_steps() -> None:
    chosen, rates = rows(3000, 500, 12), np.full(12, RATE, np.float32)
    one, many = native("sdf"), native("sdf")
    one.steps(chosen, rates)
    for threads, part in ((3, slice(0, 1)), (1, slice(1, 5)), (2, slice(5, 12))):
        many.threads = threads
        many.steps(chosen[part], rates[part])
    assert one.weights.tobytes() == many.weights.tobytes()


@pytest.mark.parametrize("cuts", [(0, 30), (0, 1, 30), (0, 0, 7, 12, 30)])
def test_steps_may_be_taken_in_any_portions(cuts: tuple[int, ...]) -> None:
    chosen, rates = rows(3000, 100, 30), np.linspace(1e-3, 1e-4, 30).astype(np.float32)
    whole, parts = native("uv"), native("uv")
    whole.steps(chosen, rates)
    for begin, end in pairwise(cuts):
        parts.steps(chosen[begin:end], rates[begin:end])
    assert whole.weights.tobytes() == parts.weights.tobytes()


def test_after_a_restart_nothing_is_remembered() -> None:
    chosen, rates = rows(3000, 100, 20), np.full(20, RATE, np.float32)
    fresh, used = native("sdf"), native("sdf")
    start = fresh.weights
    used.steps(chosen[::-1].copy(), rates)
    used.restart(start)
    assert used.mean.tobytes() == start.tobytes()
    assert fresh.steps(chosen, rates).tobytes() == used.steps(chosen, rates).tobytes()
    assert fresh.weights.tobytes() == used.weights.tobytes()


def test_the_first_step_of_soap_only_measures() -> None:
    trainer = native("one layer")
    start = some_weights(trainer.spec)
    trainer.steps(rows(3000, 100, 1), np.full(1, RATE, np.float32))
    assert trainer.weights.tobytes() == start.tobytes()
    trainer.steps(rows(3000, 100, 1), np.full(1, RATE, np.float32))
    assert trainer.weights.tobytes() != start.tobytes()


def test_a_fit_gets_better_and_ends_where_torch_ends() -> None:
    chosen, rates = rows(3000, 500, 150), np.linspace(1e-3, 1e-5, 150).astype(np.float32)
    ours, torch = native("sdf"), TorchTrainer("sdf")
    losses = ours.steps(chosen, rates)
    wanted = [torch.step(each, float(rate)) for each, rate in zip(chosen, rates, strict=True)]
    assert losses[-10:].mean() < 0.7 * losses[:10].mean()
    assert losses[-10:].mean() == pytest.approx(np.mean(wanted[-10:]), rel=0.1)
