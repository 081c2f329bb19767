"""The benchmark of rounding: what it compares with is the same fit, not rounded."""

from __future__ import annotations

import numpy as np

from benchmarks.studies.rounding_loss import floats
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import silent
from nispcodec.encode import field_form
from nispcodec.train.config import LossConfig
from nispcodec.train.objectives import SdfObjective
from nispcodec.train.task import Quantization, Schedule, Task
from tests.train.fits import ENGINE, ball_samples


def fitted() -> Network:
    samples, held_out = ball_samples(2000, 0), ball_samples(500, 1)
    task = Task(
        "sdf",
        NetworkSpec((8,), 1),
        samples,
        held_out,
        SdfObjective(LossConfig()),
        Schedule(40, 256),
        Quantization(1e-3),
    )
    # As the encoder finds it: the benchmark puts another in its place.
    fit = vars(field_form)["fit_networks"]
    return fit([task], 0, ENGINE, 1, silent)["sdf"]


def test_floats_are_what_the_same_fit_rounds() -> None:
    rounded = fitted()
    with floats():
        before = fitted()
    assert not before.steps
    assert set(rounded.steps) == set(rounded.tensors) == set(fitted().steps)
    first, second = (
        np.concatenate([t.ravel() for t in each.tensors.values()]) for each in (before, rounded)
    )
    assert not np.array_equal(first, second)
    assert np.corrcoef(first, second)[0, 1] > 0.99
