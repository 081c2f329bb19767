"""The loop: it learns, keeps its best, survives divergence, repeats exactly."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.errors import FitError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Progress
from nispcodec.core.sample_set import SampleSet
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.config import QuantizeConfig, TrainConfig
from nispcodec.train.layout import WeightLayout, four_bits
from nispcodec.train.task import Quantization
from tests.train.fits import SDF, ball_samples, chart_task, judged_by, run, sdf_task

FINE = 2.0**-24
"""A step that nobody sees."""


@pytest.mark.parametrize("optimizer", ["muon", "adam"])
def test_it_learns_a_ball(optimizer: str) -> None:
    seen: list[Progress] = []
    run(sdf_task(rate=3e-3, optimizer=optimizer), seen.append)
    assert seen[-1].error < 0.07
    assert seen[-1].error < seen[0].error or math.isnan(seen[0].error)
    assert (seen[-1].step, seen[-1].steps, seen[-1].seconds_left) == (300, 300, 0)


def test_the_returned_weights_are_the_best_seen() -> None:
    seen: list[float] = []
    task = sdf_task()

    def noted(outputs: Float32Array, samples: SampleSet) -> float:
        seen.append(SDF.error(outputs, samples))
        return seen[-1]

    network = run(judged_by(task, noted))
    final = SDF.error(evaluate(network, task.held_out.points), task.held_out)
    assert final == pytest.approx(min(seen), rel=1e-3)


def test_divergence_is_noticed_told_and_survived() -> None:
    """The held-out error is made to explode once, in the middle."""
    calls = {"count": 0}

    def explodes(outputs: Float32Array, samples: SampleSet) -> float:
        calls["count"] += 1
        return math.nan if calls["count"] == 6 else SDF.error(outputs, samples)

    notes: list[str] = []
    network = run(judged_by(sdf_task(), explodes), lambda progress: notes.append(progress.note))
    told = [note for note in notes if note]
    assert len(told) == 1
    assert "diverged" in told[0]
    assert "0.0005" in told[0]
    assert all(np.isfinite(tensor).all() for tensor in network.tensors.values())


def test_a_network_that_was_perfect_for_a_moment_has_not_diverged() -> None:
    """An error of 0 early on, and a good one ever after."""
    errors = iter([0.0] + [1e-4] * 100)
    notes: list[str] = []
    task = judged_by(chart_task(), lambda outputs, samples: next(errors))
    run(task, lambda progress: notes.append(progress.note))
    assert not any(notes)


def test_when_lower_rates_do_not_help_the_best_network_is_kept_with_a_warning() -> None:
    errors = iter([0.01] * 3 + [1.0] * 100)
    seen: list[Progress] = []
    network = run(judged_by(sdf_task(), lambda outputs, samples: next(errors)), seen.append)
    told = [progress.note for progress in seen if progress.note]
    assert [note.startswith("diverged") for note in told] == [True] * 4
    (warning,) = (progress.warning for progress in seen if progress.warning)
    assert warning.startswith("sdf network: held-out error 1 after 4 retries at lower rates")
    assert warning.endswith("0.01")
    assert seen[-1].step < 300
    assert any(tensor.any() for tensor in network.tensors.values())


@pytest.mark.parametrize("error", [math.nan, 100.0])
def test_a_useless_network_is_an_error(error: float) -> None:
    task = judged_by(sdf_task(), lambda outputs, samples: error)
    with pytest.raises(FitError, match=r"sdf network: expected a held-out error below.*converge"):
        run(task)


def test_answers_that_are_no_numbers_are_no_good_charts() -> None:
    """The first chart is what `argmax` finds in them."""
    task = chart_task(50)
    with pytest.raises(FitError, match="found inf: the fit does not converge"):
        run(replace(task, schedule=replace(task.schedule, rate=float("nan"))))


def test_the_same_seed_gives_the_same_weights() -> None:
    first, again, other = (run(sdf_task(100), seed=seed) for seed in (0, 0, 1))
    assert np.array_equal(first.tensors["weight.1"], again.tensors["weight.1"])
    assert not np.array_equal(first.tensors["weight.1"], other.tensors["weight.1"])


def test_mining_brings_back_a_part_that_few_samples_show() -> None:
    """Of 8000 samples eight lie in the small ball."""

    def small(points: Float32Array) -> Float32Array:
        far = np.linalg.norm(points - np.array([0.75, 0, 0]), axis=1)
        return (far - 0.13).astype(np.float32)

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


def vector(network: Network) -> Float32Array:
    return WeightLayout(network.spec).vector(network.tensors)


@pytest.mark.parametrize(
    ("spoils", "kept", "slight", "notable", "rise"),
    [
        ([2.0, 0.5, 1.0], 0.5, 1.05, None, 1.0),
        ([0.0], 0.0, 1.05, None, 1.0),
        ([2.0], 2.0, math.inf, None, 1.0),
        ([2.0, 0.5, 1.0], 0.5, math.inf, 1.15, 1.0),
        ([2.0], 2.0, 1.05, math.inf, 1.0),
        ([2.0], 2.0, 1.05, None, math.inf),
    ],
)
def test_rounding_that_costs_much_is_tried_again_and_the_best_stays(
    spoils: list[float],
    kept: float,
    slight: float,
    notable: float | None,
    rise: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As many times as there are `spoils`, each from the best weights; `notable`: as if large.

    `rise` is what the preset lets it cost.
    """
    untried = list(spoils)
    config = QuantizeConfig(slight=slight)
    if notable is not None:
        config = replace(config, large=0, notable=notable)

    def spoiled(unrounded: object, *_: object) -> tuple[Float32Array, Float64Array]:
        layout, weights = vars(unrounded)["layout"], vars(unrounded)["weights"]
        steps = [four_bits(FINE / scale) * scale for scale in layout.scales.values()]
        return weights + np.float32(untried.pop(0)), np.array(steps)

    monkeypatch.setattr("nispcodec.train.loop.round_weights", spoiled)
    plain = vector(run(sdf_task()))
    training = TrainConfig(quantize=config)
    task = replace(sdf_task(), quantization=Quantization(1e-3, rise=rise), config=training)
    rounded = vector(run(task))
    assert untried == []
    assert float(np.abs(rounded - plain - np.float32(kept)).max()) < 1e-5


def test_rounding_that_spoils_a_network_is_tried_again_more_finely() -> None:
    """After a short fit charts are right and not sure: rounding as of sure ones makes all wrong."""
    short = replace(chart_task(), spec=NetworkSpec((12, 12), 2, w0=5.0))
    schedule = replace(short.schedule, rate=3e-3)
    told: list[Progress] = []
    run(replace(short, schedule=schedule, quantization=Quantization(0.02)), told.append)
    before, *_, after = (update.error for update in told if update.stage == "quantize")
    assert before < 0.02
    assert after < 2 * before
