"""Rounding: weights on the grid of their steps, errors that cancel, steps that follow lambda."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.errors import FitError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.format import records
from nispcodec.train.config import LossConfig, QuantizeConfig, TrainConfig
from nispcodec.train.initialization import initial_weights
from nispcodec.train.layout import WeightLayout
from nispcodec.train.objectives import OBJECTIVES, Objective, SdfObjective
from nispcodec.train.prune import Mask, everything
from nispcodec.train.quantize import Unrounded, nearest, round_weights, shared_step
from nispcodec.train.task import Quantization, Schedule, Task
from tests.train.fits import ENGINE, ball_samples, run, sdf_task

SPECS = {
    "sdf": NetworkSpec((7, 6), 1, w0=5.0),
    "chart": NetworkSpec((8,), 3),
    "uv": NetworkSpec((6, 5), 2, conditioning="chart_affine", charts=4, embedding=3),
}
POINTS = 500
OBJECTIVE = {name: kind(LossConfig()) for name, kind in OBJECTIVES.items()}


def samples_of() -> SampleSet:
    random = np.random.default_rng(0)
    charts = random.integers(0, 3, POINTS, dtype=np.int32)
    return replace(ball_samples(POINTS, 0), chart=charts, uv=random.random((POINTS, 2), np.float32))


def unrounded(
    name: str,
    config: QuantizeConfig = QuantizeConfig(),
    objective: Objective | None = None,
    samples: SampleSet | None = None,
    mask: Mask | None = None,
) -> Unrounded:
    """A network of initial weights."""
    found = samples or samples_of()
    training = TrainConfig(quantize=config)
    judge = objective or OBJECTIVE[name]
    task = Task(name, SPECS[name], found, found, judge, Schedule(1), config=training)
    layout, weights = WeightLayout(task.spec), initial_weights(task.spec)
    kept = layout.kept(mask)
    trainer = ENGINE.trainer(task, weights, kept)
    return Unrounded(task, layout, trainer, trainer.weights, weights, kept)


@dataclass(frozen=True)
class Pair:
    """A network before and after it was rounded."""

    before: Unrounded
    weights: Float32Array
    steps: Float64Array

    @property
    def network(self) -> Network:
        return self.before.layout.network(self.weights, self.steps)

    def outputs(self, weights: Float32Array) -> Float32Array:
        samples = self.before.task.samples
        return self.before.trainer.outputs(weights, samples.points, samples.chart)

    def off(self, weights: Float32Array) -> Float32Array:
        """How far the answers are from those before."""
        return self.outputs(weights) - self.outputs(self.before.weights)


def rounded(before: Unrounded, lambda_: float, coarser: float = 0.0) -> Pair:
    random = np.random.default_rng(0)
    return Pair(before, *round_weights(before, Quantization(lambda_, coarser), random))


@pytest.mark.parametrize("name", SPECS)
def test_every_tensor_is_symbols_times_its_step(name: str) -> None:
    network = rounded(unrounded(name), 1e-3).network
    assert set(network.steps) == set(SPECS[name].shapes)
    for tensor_name, tensor in network.tensors.items():
        step = np.float32(network.steps[tensor_name])
        assert np.array_equal(tensor, np.rint(tensor / step).astype(np.float32) * step)
        assert math.frexp(network.steps[tensor_name])[0] * 16 % 1 == 0


@pytest.mark.parametrize("name", SPECS)
def test_the_file_holds_what_was_rounded(name: str) -> None:
    pair = rounded(unrounded(name), 1e-3)
    stored = pair.outputs(pair.before.layout.vector(pair.network.tensors))
    assert pair.outputs(pair.weights) == pytest.approx(stored, abs=1e-4)


def alone(pair: Pair) -> Float32Array:
    """Each weight rounded to the nearest symbol of its own, on the same grid."""
    tensors = records.tensors("sdf", pair.network)
    row_shifts = np.concatenate([tensor.row_shifts for tensor in tensors]).astype(np.float64)
    layout = pair.before.layout
    grid = pair.steps[layout.tensors] * 2 ** row_shifts[layout.rows]
    return (np.rint(pair.before.weights / grid) * grid).astype(np.float32)


@pytest.mark.parametrize("name", ["sdf", "uv"])
def test_errors_cancel(name: str) -> None:
    """Each weight to its own nearest symbol, on the same grid, changes the answers far more."""
    pair = rounded(unrounded(name), 1e-6)
    together, each_alone = (np.square(pair.off(w)).mean() for w in (pair.weights, alone(pair)))
    assert together < 0.6 * each_alone


@pytest.mark.parametrize("lambda_", [1e-2, 1e-3, 1e-4, 1e-5])
def test_it_is_never_worse_than_each_weight_by_itself(lambda_: float) -> None:
    pair = rounded(unrounded("sdf"), lambda_)
    first, samples = pair.outputs(pair.before.weights), pair.before.task.samples
    factors = OBJECTIVE["sdf"].factors(first, samples)[:, 0]
    rises = [np.square(pair.off(w) * factors).mean() for w in (pair.weights, alone(pair))]
    assert rises[0] <= rises[1]


class Squared(SdfObjective):
    """Half the mean square of the outputs."""

    damping = 1e-6

    def factors(self, outputs: Float32Array, samples: SampleSet) -> Float32Array:
        return np.ones((len(outputs), 1, 1), np.float32)


SQUARED = Squared(LossConfig())


def test_the_rise_is_what_lambda_says() -> None:
    """Of half the mean square, a loss whose second derivatives these are."""
    lambda_ = 1e-10
    pair = rounded(unrounded("sdf", objective=SQUARED), lambda_)
    rise = float(np.square(pair.off(pair.weights)).mean()) / 2
    assert rise == pytest.approx(lambda_ / (2 * math.log(2)), rel=0.5)


@given(st.integers(0, 2**32), st.integers(1, 12))
def test_nearest_is_at_most_half_a_step_off_in_the_metric(seed: int, size: int) -> None:
    """Babai's bound: half the diagonal, in every coordinate of the rotated lattice."""
    rng = np.random.default_rng(seed)
    root = np.triu(rng.normal(size=(size, size)))
    root[np.diag_indices(size)] = rng.uniform(0.1, 2, size)
    values = rng.normal(0, 10, size)
    found = nearest(values, root, np.ones(size))
    assert np.array_equal(found, np.rint(found))
    assert (np.abs(root @ (found - values)) <= np.diag(root) / 2 + 1e-9).all()


@pytest.mark.parametrize("octaves", [-2.0, 1.0, 2.5])
def test_octaves_coarser_are_about_as_many_bits_less_of_every_weight(octaves: float) -> None:
    usual, other = (rounded(unrounded("sdf"), 1e-4, each).steps for each in (0.0, octaves))
    # A file has few digits of a step.
    assert np.log2(other / usual) == pytest.approx(np.full(len(usual), octaves), abs=0.1)


def test_what_is_pruned_stays_zero_and_a_whole_tensor_may_go() -> None:
    mask = {name: np.ones_like(kept) for name, kept in everything(SPECS["sdf"]).items()}
    mask["weight.1"][:] = False
    mask["weight.0"][::2] = False
    network = rounded(unrounded("sdf", mask=mask), 1e-6).network
    assert not network.tensors["weight.1"].any()
    assert not network.tensors["weight.0"][::2].any()
    assert network.tensors["weight.0"].any()


def test_fewer_points_than_weights_will_do() -> None:
    pair = rounded(unrounded("sdf", objective=SQUARED, samples=samples_of()[:5]), 1e-6)
    assert np.isfinite(pair.weights).all()


def test_weights_that_are_not_finite_are_an_error() -> None:
    before = unrounded("sdf")
    before.weights[3] = np.nan
    with pytest.raises(FitError, match="expected finite derivatives, found NaN"):
        rounded(before, 1e-3)


def test_blocks_make_up_for_each_other() -> None:
    off = []
    for shares in ((0.0,), (0.0, 0.1, 0.3, 1.0)):
        config = QuantizeConfig(whole=0, block=40, newton_shares=shares)
        pair = rounded(unrounded("sdf", config), 1e-7)
        off.append(float(np.abs(pair.off(pair.weights)).mean()))
    assert off[1] < 0.9 * off[0]


def fitted(lambda_: float) -> Network:
    return run(replace(sdf_task(100), quantization=Quantization(lambda_)))


def test_a_higher_lambda_buys_fewer_bits() -> None:
    bits = [
        float(np.log2(network.tensors["weight.1"].std() / network.steps["weight.1"]))
        for network in (fitted(1e-3), fitted(1e-5))
    ]
    assert bits[0] < bits[1] - 0.5


def test_without_rounding_the_weights_stay_float() -> None:
    assert not run(sdf_task(50)).steps


steps_of_rows = st.lists(st.floats(1e-6, 1e3), min_size=1, max_size=40)


@given(steps_of_rows, st.sampled_from([1.0, 30.0]))
def test_rows_share_a_step_but_for_octaves(steps: list[float], scale: float) -> None:
    wanted, counts = np.array(steps), np.full(len(steps), 10.0)
    step, row_shifts = shared_step(wanted, counts, scale, 7, 1 / 16)
    assert math.frexp(step / scale)[0] * 16 == pytest.approx(
        round(math.frexp(step / scale)[0] * 16)
    )
    assert set(row_shifts.tolist()) <= set(range(8))
    assert row_shifts.max() < 1 or len(steps) > 1


def test_rows_that_matter_less_are_rounded_more_coarsely() -> None:
    wanted = 2.0 ** np.array([-9, -7, -6, -8])
    step, row_shifts = shared_step(wanted, np.full(4, 100.0), 1.0, 7, 1 / 16)
    assert (step * 2**row_shifts).tolist() == wanted.tolist()


def test_octaves_that_save_less_than_they_take_are_left_out() -> None:
    _, row_shifts = shared_step(np.array([1.0, 1.5, 1.0, 1.3]), np.full(4, 3.0), 1.0, 7, 1 / 16)
    assert not row_shifts.any()


def test_rows_without_weights_have_no_say() -> None:
    wanted, counts = np.array([1e-6, 0.5, 0.5, 1e-6]), np.array([0.0, 9.0, 9.0, 0.0])
    assert shared_step(wanted, counts, 1.0, 7, 1 / 16)[0] == 0.5
    assert shared_step(wanted, np.zeros(4), 1.0, 7, 1 / 16)[0] == 1.0
