"""Rounding: weights on the grid of their steps, errors that cancel, steps that follow lambda."""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FitError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import silent
from nispcodec.format import records
from nispcodec.train.backend.torch.module import Module, snapped
from nispcodec.train.batch import Batch
from nispcodec.train.config import LossConfig, QuantizeConfig
from nispcodec.train.loop import train
from nispcodec.train.objectives import OBJECTIVES, SdfObjective
from nispcodec.train.prune import everything
from nispcodec.train.quantize import nearest, round_weights, shared_step
from nispcodec.train.task import Quantization
from tests.train.test_loop import ball_samples, module_of, sdf_task

SPECS = {
    "sdf": NetworkSpec((7, 6), 1, w0=5.0),
    "chart": NetworkSpec((8,), 3),
    "uv": NetworkSpec((6, 5), 2, conditioning="chart_affine", charts=4, embedding=3),
}
POINTS = 500
OBJECTIVE = {name: kind(LossConfig()) for name, kind in OBJECTIVES.items()}


def batch(name: str) -> Batch:
    generator = torch.Generator().manual_seed(0)
    points = Batch.of(ball_samples(POINTS, 0), "cpu")
    charts = torch.randint(3, (POINTS,), generator=generator)
    return replace(points, chart=charts, uv=torch.rand(POINTS, 2, generator=generator))


def rounded(
    name: str, lambda_: float, config: QuantizeConfig = QuantizeConfig()
) -> tuple[Module, Module]:
    """A module of random weights, and the same rounded."""
    before, after = (Module(SPECS[name], "cpu") for _ in range(2))
    generator = torch.Generator().manual_seed(0)
    round_weights(after, batch(name), Quantization(lambda_), OBJECTIVE[name], generator, config)
    return before, after


@pytest.mark.parametrize("name", SPECS)
def test_every_tensor_is_symbols_times_its_step(name: str) -> None:
    network = rounded(name, 1e-3)[1].network()
    assert set(network.steps) == set(SPECS[name].shapes)
    for tensor_name, tensor in network.tensors.items():
        step = np.float32(network.steps[tensor_name])
        assert np.array_equal(tensor, np.rint(tensor / step).astype(np.float32) * step)
        assert math.frexp(network.steps[tensor_name])[0] * 16 % 1 == 0


@pytest.mark.parametrize("name", SPECS)
def test_the_file_holds_what_was_rounded(name: str) -> None:
    module = rounded(name, 1e-3)[1]
    part = batch(name)
    stored = module_of(module.network())(part.points, part.chart).detach()
    assert torch.allclose(module(part.points, part.chart).detach(), stored, atol=1e-4)


def outputs(module: Module, part: Batch) -> torch.Tensor:
    return module(part.points, part.chart).detach()


def alone(before: Module, after: Module) -> Module:
    """A copy, each weight rounded to the nearest symbol of its own, on the other's grid."""
    assert after.steps is not None
    module = Module(before.spec, "cpu")
    row_shifts = np.concatenate(
        [tensor.row_shifts for tensor in records.tensors("sdf", after.network())]
    )
    grid = after.steps[after.groups] * 2 ** torch.from_numpy(row_shifts)[after.rows]
    module.weights.data = ((before.weights.detach() / grid).round() * grid).float()
    return module


@pytest.mark.parametrize("name", ["sdf", "uv"])
def test_errors_cancel(name: str) -> None:
    """Each weight to its own nearest symbol, on the same grid, changes the answers far more."""
    before, after = rounded(name, 1e-6)
    part, each_alone = batch(name), alone(before, after)
    off = [
        (outputs(module, part) - outputs(before, part)).square().mean()
        for module in (after, each_alone)
    ]
    assert off[0] < 0.6 * off[1]


@pytest.mark.parametrize("lambda_", [1e-2, 1e-3, 1e-4, 1e-5])
def test_it_is_never_worse_than_each_weight_by_itself(lambda_: float) -> None:
    before, after = rounded("sdf", lambda_)
    part, each_alone = batch("sdf"), alone(before, after)
    factors = OBJECTIVE["sdf"].factors(outputs(before, part), part)[:, 0]
    rises = [
        ((outputs(module, part) - outputs(before, part)) * factors).square().mean()
        for module in (after, each_alone)
    ]
    assert rises[0] <= rises[1]


@pytest.mark.parametrize("name", SPECS)
def test_factors_are_of_the_shape_of_the_outputs(name: str) -> None:
    part = batch(name)
    found = OBJECTIVE[name].factors(outputs(rounded(name, 1e-3)[0], part), part)
    assert found.shape[:2] == (POINTS, SPECS[name].outputs)
    assert torch.isfinite(found).all()


class Squared(SdfObjective):
    """Half the mean square of the outputs."""

    damping = 1e-6

    def factors(self, outputs: torch.Tensor, batch: Batch) -> torch.Tensor:
        return torch.ones(len(outputs), 1, 1)


def test_the_rise_is_what_lambda_says() -> None:
    """Of half the mean square, a loss whose second derivatives these are."""
    module = Module(SPECS["sdf"], "cpu")
    part = batch("sdf")
    before, lambda_ = outputs(module, part), 1e-10
    objective = Squared(LossConfig())
    round_weights(module, part, Quantization(lambda_), objective, torch.Generator().manual_seed(0))
    rise = float((outputs(module, part) - before).square().mean()) / 2
    assert rise == pytest.approx(lambda_ / (2 * math.log(2)), rel=0.5)


@given(st.integers(0, 2**32), st.integers(1, 12))
def test_nearest_is_at_most_half_a_step_off_in_the_metric(seed: int, size: int) -> None:
    """Babai's bound: half the diagonal, in every coordinate of the rotated lattice."""
    rng = np.random.default_rng(seed)
    root = np.triu(rng.normal(size=(size, size)))
    root[np.diag_indices(size)] = rng.uniform(0.1, 2, size)
    values = rng.normal(0, 10, size)
    found = nearest(values, root)
    assert np.array_equal(found, np.rint(found))
    assert (np.abs(root @ (found - values)) <= np.diag(root) / 2 + 1e-9).all()


@pytest.mark.parametrize("bits", [4.0, 7.0, 10.0])
def test_a_budget_is_kept(bits: float) -> None:
    """Of how far weights went from where they began, as a file has it."""
    module, generator = Module(SPECS["sdf"], "cpu"), torch.Generator().manual_seed(0)
    module.weights.data += module.first * torch.randn(len(module.first), generator=generator) / 2
    count = len(module.weights)
    budget = bits * count + QuantizeConfig.header_bits * len(module.scales)
    quantization = Quantization(1e-3, budget)
    round_weights(module, batch("sdf"), quantization, OBJECTIVE["sdf"], generator)
    found = sum(
        moves.size * max(0.0, math.log2(float(np.abs(moves).mean()) * 5.18))
        for moves in (
            each.values(each.row_shifts, True) for each in records.tensors("sdf", module.network())
        )
        if moves.any()
    )
    assert found / count == pytest.approx(bits, rel=0.2)


def test_what_is_pruned_stays_zero_and_a_whole_tensor_may_go() -> None:
    module = Module(SPECS["sdf"], "cpu")
    mask = {name: np.ones_like(kept) for name, kept in everything(SPECS["sdf"]).items()}
    mask["weight.1"][:] = False
    mask["weight.0"][::2] = False
    module.prune(mask)
    quantization, objective = Quantization(1e-6), OBJECTIVE["sdf"]
    round_weights(module, batch("sdf"), quantization, objective, torch.Generator().manual_seed(0))
    network = module.network()
    assert not network.tensors["weight.1"].any()
    assert not network.tensors["weight.0"][::2].any()
    assert network.tensors["weight.0"].any()


def test_fewer_points_than_weights_will_do() -> None:
    module = Module(SPECS["sdf"], "cpu")
    few = next(iter(batch("sdf").parts(5)))
    quantization, objective = Quantization(1e-6), Squared(LossConfig())
    round_weights(module, few, quantization, objective, torch.Generator().manual_seed(0))
    assert torch.isfinite(module.weights).all()


def test_weights_that_are_not_finite_are_an_error() -> None:
    module = Module(SPECS["sdf"], "cpu")
    module.weights.data[3] = float("nan")
    quantization, objective = Quantization(1e-3), OBJECTIVE["sdf"]
    with pytest.raises(FitError, match="expected finite derivatives, found NaN"):
        round_weights(
            module, batch("sdf"), quantization, objective, torch.Generator().manual_seed(0)
        )


def test_blocks_make_up_for_each_other() -> None:
    part, off = batch("sdf"), []
    for size, shares in ((40, (0.0,)), (40, (0.0, 0.1, 0.3, 1.0))):
        config = QuantizeConfig(whole=0, block=size, newton_shares=shares)
        before, after = rounded("sdf", 1e-7, config)
        off.append(float((outputs(before, part) - outputs(after, part)).abs().mean()))
    assert off[1] < 0.9 * off[0]


@pytest.mark.parametrize("step", [1e-9, 0.0123, 1.0, 31.9, 1e6])
def test_a_snapped_step_is_near_and_stays(step: float) -> None:
    near = snapped(step)
    assert near == pytest.approx(step, rel=1 / 16)
    assert snapped(near * (1 + 1e-6)) == near
    assert math.frexp(near)[0] * 16 % 1 == 0


def fitted(lambda_: float) -> Network:
    task = replace(sdf_task(100), quantization=Quantization(lambda_))
    return train(task, 0, "cpu", threading.Lock(), silent)


def test_a_higher_lambda_buys_fewer_bits() -> None:
    bits = [
        float(np.log2(network.tensors["weight.1"].std() / network.steps["weight.1"]))
        for network in (fitted(1e-3), fitted(1e-5))
    ]
    assert bits[0] < bits[1] - 0.5


def test_without_rounding_the_weights_stay_float() -> None:
    assert not train(sdf_task(50), 0, "cpu", threading.Lock(), silent).steps


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
