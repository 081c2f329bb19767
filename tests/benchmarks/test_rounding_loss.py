"""The benchmark of rounding: what it compares with is the same fit, not rounded."""

from __future__ import annotations

import numpy as np

from benchmarks.rounding_loss import floats
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import silent
from nispcodec.train import workers as parallel
from nispcodec.train.backend.torch.losses import CURVATURES, distance_error, relative_distance_loss
from nispcodec.train.task import Rounding, Schedule, Task
from tests.train.test_loop import ball_samples


def fitted() -> Network:
    samples, held_out = ball_samples(2000, 0), ball_samples(500, 1)
    task = Task(
        "sdf",
        NetworkSpec((8,), 1),
        samples,
        held_out,
        relative_distance_loss,
        distance_error,
        Schedule(40, 256),
        Rounding(CURVATURES["sdf"], 1e-3),
    )
    return parallel.fit_networks([task], 0, "cpu", 1, silent)["sdf"]


def test_floats_are_what_the_same_fit_rounds() -> None:
    rounded = fitted()
    with floats():
        before = fitted()
    assert not before.steps
    assert set(rounded.steps) == set(rounded.tensors) == set(fitted().steps)
    weights = [
        np.concatenate([t.ravel() for t in each.tensors.values()]) for each in (before, rounded)
    ]
    assert not np.array_equal(*weights)
    assert np.corrcoef(*weights)[0, 1] > 0.99
