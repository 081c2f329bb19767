from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.sample_set import SampleSet
from tests.train.backend.native.reference import CASES, by_torch, native, relative, samples

COUNT = 60


def asked(name: str) -> SampleSet:
    return samples(CASES[name][0], COUNT, seed=5)


@pytest.mark.parametrize("name", CASES)
def test_outputs_are_those_of_torch(name: str) -> None:
    trainer, points = native(name), asked(name)
    found = trainer.outputs(trainer.weights, points.points, points.chart)
    wanted = by_torch(name).outputs(trainer.weights, points.points, points.chart)
    assert found.shape == wanted.shape
    assert relative(found, wanted) < 2e-6


@pytest.mark.parametrize("name", ["sdf", "signed axes", "charts", "uv, 40 charts"])
def test_slopes_are_those_of_torch(name: str) -> None:
    trainer, points = native(name), asked(name)
    outputs = trainer.spec.outputs
    directions = np.random.default_rng(6).normal(size=(COUNT, outputs)).astype(np.float32)
    told = (trainer.weights, points.points, points.chart, directions)
    wanted = by_torch(name).slopes(*told)
    found = trainer.slopes(*told)
    assert relative(found, wanted) < 2e-6
    places = np.random.default_rng(7).integers(0, trainer.spec.weight_count, 50)
    assert (trainer.slopes(*told, places) == found[:, places]).all()


def test_answers_are_the_same_with_several_threads() -> None:
    trainer, points = native("uv, 40 charts"), samples(CASES["uv, 40 charts"][0], 2900, seed=8)
    told = (trainer.weights, points.points, points.chart)
    directions = np.ones((2900, 2), np.float32)
    outputs, slopes = trainer.outputs(*told), trainer.slopes(*told, directions)
    trainer.threads = 3
    assert trainer.outputs(*told).tobytes() == outputs.tobytes()
    assert trainer.slopes(*told, directions).tobytes() == slopes.tobytes()


def test_no_points_have_no_answers() -> None:
    trainer = native("charts")
    points = np.empty((0, 3), np.float32)
    assert trainer.outputs(trainer.weights, points).shape == (0, 40)
    none = np.empty((0, 40), np.float32)
    assert trainer.slopes(trainer.weights, points, None, none).shape == (0, trainer.weights.size)
