"""A fit that went wrong is made again from another seed; the better of the two stays."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import nispcodec.train.loop as loop
from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import MAX_INIT_SEED, Network, NetworkSpec
from nispcodec.core.progress import Progress
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.config import TrainConfig
from nispcodec.train.initialization import initial_weights
from nispcodec.train.prune import everything
from nispcodec.train.task import Task
from tests.train.fits import SDF, run, sdf_task

OTHER = (MAX_INIT_SEED + 1) // 2


def error_of(network: Network, task: Task) -> float:
    return SDF.error(evaluate(network, task.held_out.points), task.held_out)


@pytest.fixture
def dead_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """The usual seed starts with weights that are all 0: no sine of it ever learns."""
    usual = initial_weights

    def weights(spec: NetworkSpec, scale: float) -> Float32Array:
        found = usual(spec, scale)
        return found if spec.init_seed == OTHER else np.zeros_like(found)

    monkeypatch.setattr(loop, "initial_weights", weights)


def test_a_bad_start_is_seen_and_made_good(dead_start: None) -> None:
    told: list[Progress] = []
    task = sdf_task(600, rate=3e-3)
    alone = error_of(run(task), task)
    mended = run(replace(task, foreseen=0.05), told.append)
    assert mended.spec.init_seed == OTHER
    assert error_of(mended, task) < 0.5 * alone
    notes = [update.note for update in told if update.note]
    assert "foreseen 0.05: a fit that went wrong" in notes[0]
    # What is told of the second fit does not fall back to its beginning.
    steps = [update.step for update in told]
    assert steps == sorted(steps)
    assert {update.steps for update in told} == {600}


def test_the_second_fit_takes_its_share_of_the_steps_and_the_better_one_stays() -> None:
    task = sdf_task()
    first, second = run(task), run(replace(task, schedule=replace(task.schedule, steps=150)))
    assert error_of(first, task) < error_of(second, task)
    twice = run(replace(task, foreseen=0.0, config=half_again(task)))
    assert twice.spec.init_seed == first.spec.init_seed == 0
    assert all(np.array_equal(twice.tensors[name], first.tensors[name]) for name in first.tensors)


def half_again(task: Task) -> TrainConfig:
    """Whatever the first fit reaches, half of the steps again."""
    changed = replace(task.config.loop, again_unnoticed=0.0, again_steps=0.5)
    return replace(task.config, loop=changed)


@pytest.mark.parametrize("foreseen", [math.inf, 10.0])
def test_a_fit_that_did_as_well_is_not_made_again(foreseen: float) -> None:
    told: list[Progress] = []
    run(replace(sdf_task(), foreseen=foreseen), told.append)
    assert not any(update.note for update in told)


def test_a_lottery_ticket_keeps_its_initial_weights(dead_start: None) -> None:
    task = replace(sdf_task(), foreseen=0.05)
    assert run(task, mask=everything(task.spec)).spec.init_seed == 0


def test_an_error_that_nobody_notices_is_no_reason() -> None:
    generous = replace(sdf_task().config, loop=replace(sdf_task().config.loop, again_unnoticed=1e3))
    told: list[Progress] = []
    run(replace(sdf_task(), foreseen=0.0, config=generous), told.append)
    assert not any(update.note for update in told)
