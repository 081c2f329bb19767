"""Objectives: each loss is least where the answer is right; errors are in their units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array
from nispcodec.train.config import LossConfig
from nispcodec.train.objectives import OBJECTIVES, Objective, PaperSdfObjective
from tests.train.fits import ball_samples

SAMPLES = replace(ball_samples(400, 0), uv=np.random.default_rng(0).random((400, 2), np.float32))
KINDS: dict[str, type[Objective]] = {**OBJECTIVES, "paper sdf": PaperSdfObjective}
RIGHT = {
    "sdf": SAMPLES.sdf[:, None],
    "paper sdf": SAMPLES.sdf[:, None],
    "chart": 40 * np.eye(2, dtype=np.float32)[SAMPLES.chart],
    "uv": SAMPLES.uv,
}


def objective(name: str) -> Objective:
    return KINDS[name](LossConfig())


def noisy(name: str) -> Float32Array:
    noise = np.random.default_rng(1).normal(0, 30, RIGHT[name].shape)
    return (RIGHT[name] + noise).astype(np.float32)


@pytest.mark.parametrize("name", KINDS)
def test_the_right_answer_costs_least(name: str) -> None:
    found = objective(name)
    assert found.error(RIGHT[name], SAMPLES) == pytest.approx(0, abs=1e-7)
    assert found.loss(RIGHT[name], SAMPLES) < found.loss(noisy(name), SAMPLES)
    assert found.error(noisy(name), SAMPLES) > 0


@pytest.mark.parametrize("name", KINDS)
def test_no_constant_is_better_than_ignorance(name: str) -> None:
    found = objective(name)
    for constant in np.random.default_rng(2).random((20, RIGHT[name].shape[1])):
        outputs = np.tile(constant.astype(np.float32), (len(SAMPLES), 1))
        assert found.error(outputs, SAMPLES) >= found.ignorance(SAMPLES) * 0.999
    assert 0 < found.good < found.ignorance(SAMPLES)


@pytest.mark.parametrize("name", ["sdf", "uv"])
def test_the_curvature_of_a_loss_is_its_own(name: str) -> None:
    assert objective(name).own_curvature
    assert not objective("chart").own_curvature


@pytest.mark.parametrize("name", KINDS)
def test_factors_have_a_row_for_every_output(name: str) -> None:
    factors = objective(name).factors(noisy(name), SAMPLES)
    assert factors.shape[:2] == RIGHT[name].shape
    assert np.isfinite(factors).all()
    assert objective(name).damping > 0


def test_a_chart_that_is_sure_bends_less_than_one_in_doubt() -> None:
    outputs = np.array([[0, 1], [0, 50]], np.float32)
    few = SAMPLES[:2]
    doubt, sure = np.abs(objective("chart").factors(outputs, few)).sum(axis=(1, 2))
    assert doubt > 2 * sure > 0


def test_a_uv_that_is_wrong_is_wrong_however_far() -> None:
    limit = LossConfig.uv_error_limit
    assert objective("uv").error(SAMPLES.uv + 5, SAMPLES) == pytest.approx(limit)
