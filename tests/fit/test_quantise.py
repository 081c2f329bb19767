"""Quantised training: weights on the grid of their steps, steps that follow the price."""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import numpy as np
import pytest
import torch

from nispcodec.fit.module import Module
from nispcodec.fit.quantise import Quantiser, snapped
from nispcodec.fit.train import train
from nispcodec.network import NetworkSpec
from nispcodec.progress import silent
from tests.fit.test_train import module_of, sdf_task

UV = NetworkSpec((6, 5), 2, conditioning="embedding", charts=4, embedding=3)


def quantised_module() -> Module:
    module = Module(UV, torch.Generator().manual_seed(0), "cpu")
    module.quantise()
    assert module.quantiser is not None
    module.settle()
    return module


def test_every_tensor_is_symbols_times_its_step() -> None:
    network = quantised_module().network()
    assert set(network.steps) == set(UV.shapes)
    for name, tensor in network.tensors.items():
        symbols = np.rint(tensor / np.float32(network.steps[name]))
        assert np.array_equal(tensor, symbols.astype(np.float32) * np.float32(network.steps[name]))


def test_training_computes_what_the_file_will_hold() -> None:
    module = quantised_module()
    points = torch.rand(20, 3, generator=torch.Generator().manual_seed(1))
    charts = torch.arange(20) % 4
    stored = module_of(module.network())
    expected = stored(points, charts).detach().numpy()
    assert module(points, charts).detach().numpy() == pytest.approx(expected, abs=1e-4)


def test_the_gradient_of_a_step_is_that_of_the_rounding() -> None:
    """Without a change of symbols the rounded weight is linear in the step."""
    weights = torch.tensor([0.31, -0.7], requires_grad=True)
    quantiser = Quantiser(weights, torch.tensor([0, 1]))
    rounded = quantiser.rounded(weights)
    rounded.sum().backward()
    error = (rounded - weights).detach()
    assert weights.grad is not None
    assert quantiser.log_steps.grad is not None
    assert torch.equal(weights.grad, torch.ones(2))
    assert torch.allclose(quantiser.log_steps.grad, error * np.log(2))


def bits_of(weights: torch.Tensor, log_steps: torch.Tensor) -> float:
    """The entropy of a Gaussian on the grid, for 15 weights and then 5."""
    parts = [weights.detach()[:15], weights.detach()[15:]]
    return sum(
        part.numel() * float(torch.log2(part.square().mean().sqrt() * 4.1327) - step)
        for part, step in zip(parts, log_steps.detach(), strict=True)
    )


def test_the_charge_is_the_gradient_of_the_rate() -> None:
    generator = torch.Generator().manual_seed(0)
    weights = torch.randn(20, generator=generator).requires_grad_()
    quantiser = Quantiser(weights, (torch.arange(20) >= 15).long())
    quantiser.charge(weights, 1.0)
    assert weights.grad is not None
    assert quantiser.log_steps.grad is not None
    for tensor, gradient, index in (
        (weights.data, weights.grad.clone(), (9,)),
        (quantiser.log_steps.data, quantiser.log_steps.grad.clone(), (0,)),
    ):
        rates = []
        for sign in (1, -1):
            tensor[index] += sign * 1e-2
            rates.append(bits_of(weights, quantiser.log_steps))
            tensor[index] -= sign * 1e-2
        assert float(gradient[index]) == pytest.approx((rates[0] - rates[1]) / 2e-2, rel=0.02)


@pytest.mark.parametrize("step", [1e-9, 0.0123, 1.0, 31.9, 1e6])
def test_a_snapped_step_is_near_and_stays(step: float) -> None:
    near = snapped(step)
    assert near == pytest.approx(step, rel=1 / 16)
    assert snapped(near * (1 + 1e-6)) == near
    assert math.frexp(near)[0] * 16 % 1 == 0


def test_settled_steps_are_what_is_stored() -> None:
    module = quantised_module()
    assert module.quantiser is not None
    stored = module.network().steps["weight.0"] * module.scales["weight.0"]
    steps = dict(zip(UV.shapes, module.quantiser.steps, strict=True))
    assert float(steps["weight.0"]) == pytest.approx(stored, rel=1e-5)


def bits(price: float) -> float:
    task = sdf_task(400)
    task = replace(task, schedule=replace(task.schedule, price=price))
    network = train(task, 0, "cpu", threading.Lock(), silent)
    tensor, step = network.tensors["weight.1"], network.steps["weight.1"]
    return float(np.log2(tensor.std() / step))


def test_a_higher_price_buys_fewer_bits() -> None:
    assert bits(0.3) < bits(0.003) - 0.5


def test_without_a_price_the_weights_stay_float() -> None:
    assert not train(sdf_task(50), 0, "cpu", threading.Lock(), silent).steps
