from __future__ import annotations

import gc
import resource
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.network import NetworkSpec
from nispcodec.train.backend.native.library import NativeError, library
from nispcodec.train.backend.native.trainer import NativeTrainer, why_not
from tests.train.backend.native.reference import (
    CASES,
    SETTINGS,
    native,
    rows,
    samples,
    some_weights,
)


def test_trainers_free_their_memory() -> None:
    spec = CASES["sdf"][0]
    start, few = some_weights(spec), samples(spec, 50)
    chosen, rates = rows(50, 20, 2), np.full(2, 1e-3, np.float32)

    def use(count: int) -> int:
        for index in range(count):
            trainer = NativeTrainer(spec, few, "sdf", start, None, SETTINGS, 1 + index % 3)
            trainer.steps(chosen, rates)
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = use(100)
    # A trainer takes half a megabyte.
    assert use(1000) - before < 20_000


@pytest.mark.parametrize(
    ("spec", "loss", "optimizer", "reason"),
    [
        (NetworkSpec((8,), 1, encoding="fourier", levels=3), "sdf", "muon", "fourier"),
        (NetworkSpec((8,), 1, activation="relu"), "sdf", "muon", "relu"),
        (NetworkSpec((8,), 1, output="tanh"), "sdf", "muon", "tanh"),
        (NetworkSpec((8,), 2, conditioning="scalar", charts=3), "uv", "muon", "scalar"),
        (NetworkSpec((8,), 1), "sdf", "adam", "adam"),
        (NetworkSpec((8,), 1), "paper", "muon", "paper"),
        (NetworkSpec((8,), 2), "sdf", "muon", "2 outputs"),
        (NetworkSpec((8,), 3), "uv", "muon", "3 outputs"),
        (
            NetworkSpec((8,), 1, conditioning="chart_affine", charts=3, embedding=2),
            "sdf",
            "muon",
            "charts",
        ),
    ],
)
def test_what_it_cannot_do_is_said(
    spec: NetworkSpec, loss: str, optimizer: str, reason: str
) -> None:
    assert reason in why_not(spec, loss, optimizer)
    if optimizer == "muon":
        with pytest.raises(NativeError, match=reason):
            NativeTrainer(spec, samples(spec), loss, some_weights(spec), None, SETTINGS)


@pytest.mark.parametrize("name", CASES)
def test_the_presets_networks_can_be_trained(name: str) -> None:
    assert why_not(*CASES[name], "muon") == ""


def test_an_unknown_instruction_set_is_refused() -> None:
    with pytest.raises(NativeError, match="mmx"):
        library("mmx")


@pytest.mark.parametrize(
    "wrong",
    [
        rows(3001, 10) * 0 + 3000,
        rows(3000, 10) * 0 - 1,
        rows(3000, 10).astype(np.int64),
        rows(3000, 10)[0],
        rows(3000, 10)[:, ::2],
        rows(3000, 0),
    ],
)
def test_wrong_rows_are_refused(wrong: Any) -> None:
    with pytest.raises(ValueError, match="rows"):
        native("sdf").steps(wrong, np.full(1, 1e-3, np.float32))
    if wrong.ndim == 2:
        with pytest.raises(ValueError, match="rows"):
            native("sdf").gradient(wrong[0])


def test_wrong_arrays_are_refused() -> None:
    trainer, some = native("uv, 40 charts"), samples(CASES["uv, 40 charts"][0])
    weights, points, charts = trainer.weights, some.points, some.chart
    directions = np.ones((len(points), 2), np.float32)
    with pytest.raises(ValueError, match="rates"):
        trainer.steps(rows(3000, 10, 2), np.full(3, 1e-3, np.float32))
    with pytest.raises(ValueError, match="weights"):
        trainer.restart(weights[:-1])
    with pytest.raises(ValueError, match="weights"):
        trainer.outputs(weights.astype(np.float64), points, charts)
    with pytest.raises(ValueError, match="points"):
        trainer.outputs(weights, points[:, :2], charts)
    for wrong in (None, charts[:-1], charts + 40, charts - 40):
        with pytest.raises(ValueError, match="charts"):
            trainer.outputs(weights, points, wrong)
    with pytest.raises(ValueError, match="directions"):
        trainer.slopes(weights, points, charts, directions[:, :1])
    for place in (-1, trainer.spec.weight_count):
        with pytest.raises(ValueError, match="places"):
            trainer.slopes(weights, points, charts, directions, np.array([place]))
    for threads in (0, -1, 1000):
        with pytest.raises(ValueError, match="threads"):
            trainer.threads = threads


@pytest.mark.parametrize("name", ["charts", "uv, 40 charts"])
def test_samples_that_do_not_fit_are_refused(name: str) -> None:
    (spec, loss), right = CASES[name], samples(CASES[name][0])
    for wrong in (
        replace(right, chart=right.chart + 1),
        replace(right, chart=right.chart - 1),
        replace(right, chart=right.chart[1:]),
        replace(right, sdf=right.sdf[1:]),
        replace(right, uv=right.uv[:, :1]),
        replace(right, points=right.points[:, :2]),
    ):
        with pytest.raises(ValueError, match="of the samples"):
            NativeTrainer(spec, wrong, loss, some_weights(spec), None, SETTINGS)
    with pytest.raises(ValueError, match="kept"):
        NativeTrainer(spec, right, loss, some_weights(spec), np.ones(3, np.float32), SETTINGS)
    with pytest.raises(ValueError, match="weights"):
        NativeTrainer(spec, right, loss, np.ones(3, np.float32), None, SETTINGS)
