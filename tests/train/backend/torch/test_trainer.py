"""The torch backend: gradients of the losses that objectives name, and devices that exist."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from nispcodec.core.arrays import Int32Array
from nispcodec.core.errors import FitError
from nispcodec.train.backend.torch.engine import torch_engine
from nispcodec.train.backend.torch.losses import LOSSES
from nispcodec.train.config import LossConfig
from nispcodec.train.initialization import initial_weights
from nispcodec.train.objectives import OBJECTIVES, Objective, PaperSdfObjective
from nispcodec.train.task import Task
from tests.train.fits import ENGINE, chart_task, sdf_task, uv_task

ROWS: Int32Array = np.arange(200, dtype=np.int32)
TASKS = {
    "sdf": sdf_task(),
    "paper_sdf": replace(sdf_task(), objective=PaperSdfObjective(LossConfig())),
    "chart": chart_task(),
    "uv": uv_task(),
}


def test_every_objective_has_its_loss() -> None:
    kinds: list[type[Objective]] = [*OBJECTIVES.values(), PaperSdfObjective]
    names = {kind.loss_name for kind in kinds}
    assert names == set(LOSSES) == set(TASKS)


@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_the_loss_is_the_objectives(task: Task) -> None:
    weights = initial_weights(task.spec)
    trainer, part = ENGINE.trainer(task, weights, None), task.samples[ROWS]
    loss, _ = trainer.gradient(ROWS)
    outputs = trainer.outputs(weights, part.points, part.chart)
    assert loss == pytest.approx(task.objective.loss(outputs, part), rel=1e-5)


@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_slopes_add_up_to_the_change_of_the_outputs(task: Task) -> None:
    weights, part = initial_weights(task.spec), task.samples[ROWS]
    trainer = ENGINE.trainer(task, weights, None)
    step = 1e-4 * np.random.default_rng(0).normal(size=len(weights)).astype(np.float32)
    along = np.ones((len(part), task.spec.outputs), np.float32)
    slopes = trainer.slopes(weights, part.points, part.chart, along)
    ends = [trainer.outputs(weights + sign * step, part.points, part.chart) for sign in (1, -1)]
    change = ((ends[0] - ends[1]) * along).sum(axis=1) / 2
    assert slopes @ step == pytest.approx(change, abs=2e-2 * float(np.abs(change).max()))
    places = np.array([len(weights) - 1, 0, 3])
    some = trainer.slopes(weights, part.points, part.chart, along, places)
    assert (some == slopes[:, places]).all()


@pytest.mark.parametrize("device", ["gpu", "mps", "cuda:99x", ""])
def test_a_device_that_is_not_there_is_an_error(device: str) -> None:
    if torch.cuda.is_available() and device.startswith("cuda"):
        pytest.skip("this machine has CUDA")
    with pytest.raises(FitError, match="device"):
        torch_engine(device)
