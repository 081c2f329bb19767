from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import NetworkSpec
from nispcodec.train.backend.native.trainer import NativeTrainer
from tests.train.backend.native.reference import (
    CASES,
    SETTINGS,
    exact_gradient,
    native,
    relative,
    rows,
    samples,
    some_weights,
)

# Sums of some hundred float32 products, through a few layers: 1e-7 each; where a loss has a kink,
# no sample of these is so near that rounding would put it on the other side.
TOLERANCE = 2e-6


@pytest.mark.parametrize("batch", [1000, 37])
@pytest.mark.parametrize("name", CASES)
def test_gradients_are_those_of_torch_in_float64(name: str, batch: int) -> None:
    chosen = rows(3000, batch)[0]
    loss, found = native(name).gradient(chosen)
    wanted_loss, wanted = exact_gradient(name, chosen)
    assert loss == pytest.approx(wanted_loss, rel=TOLERANCE)
    assert relative(found, wanted) < TOLERANCE


@pytest.mark.parametrize("name", ["sdf", "charts", "uv, 40 charts", "unequal"])
def test_every_instruction_set_computes_the_same(name: str, isa: str) -> None:
    chosen = rows(3000, 1000)[0]
    loss, found = native(name, isa).gradient(chosen)
    wanted_loss, wanted = exact_gradient(name, chosen)
    assert loss == pytest.approx(wanted_loss, rel=TOLERANCE)
    assert relative(found, wanted) < TOLERANCE


@pytest.mark.parametrize("batch", [1, 2, 3, 255, 256, 257, 1024, 3000])
def test_any_batch_size_works(batch: int, isa: str) -> None:
    chosen = rows(3000, batch)[0]
    _, found = native("mirrored", isa).gradient(chosen)
    assert relative(found, exact_gradient("mirrored", chosen)[1]) < TOLERANCE


@pytest.mark.parametrize("width", range(1, 14))
def test_any_width_works(width: int, isa: str) -> None:
    spec = NetworkSpec((width, 14 - width), 1)
    weights, chosen = some_weights(spec), rows(3000, 100)[0]
    trainer = NativeTrainer(spec, samples(spec), "sdf", weights, None, SETTINGS, isa=isa)
    assert relative(trainer.gradient(chosen)[1], exact_gradient(spec, chosen)[1]) < TOLERANCE


def test_losses_far_from_the_surface_do_not_overflow() -> None:
    trainer = native("sdf")
    weights = trainer.weights
    weights[-1] = 1e4
    trainer.restart(weights)
    loss, found = trainer.gradient(rows(3000, 100)[0])
    assert np.isfinite(loss)
    assert np.isfinite(found).all()


def test_logits_far_apart_do_not_overflow() -> None:
    trainer = native("charts")
    weights = trainer.weights
    weights[-40:] = np.linspace(-1e4, 1e4, 40)
    trainer.restart(weights)
    loss, found = trainer.gradient(rows(3000, 100)[0])
    assert np.isfinite(loss)
    assert np.isfinite(found).all()


def test_weights_that_are_no_numbers_show_and_do_not_crash() -> None:
    trainer = native("sdf")
    weights = trainer.weights
    weights[5] = np.nan
    trainer.restart(weights)
    losses = trainer.steps(rows(3000, 64, 25), np.full(25, 1e-3, np.float32))
    assert np.isnan(losses).all()
    assert np.isnan(trainer.weights).any()
