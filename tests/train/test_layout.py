"""The vector of the weights: every place is of one tensor, row and matrix, and comes back."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nispcodec.core.network import NetworkSpec
from nispcodec.train.layout import WeightLayout, four_bits
from nispcodec.train.prune import everything
from tests import tiny

SPECS = {
    "sdf": NetworkSpec((5, 4), 1),
    "uv": NetworkSpec((4, 4), 2, conditioning="chart_affine", charts=3, embedding=2),
}


@pytest.mark.parametrize("name", SPECS)
def test_every_weight_is_in_one_matrix(name: str) -> None:
    layout = WeightLayout(SPECS[name])
    tables = [] if layout.tables is None else [layout.tables]
    places = np.concatenate([each.ravel() for each in (*layout.layers, *tables)])
    assert np.array_equal(np.sort(places), np.arange(SPECS[name].weight_count))


@pytest.mark.parametrize("name", SPECS)
def test_a_network_comes_back(name: str) -> None:
    layout, network = WeightLayout(SPECS[name]), tiny.random_network(SPECS[name], 0)
    again = layout.network(layout.vector(network.tensors))
    for tensor, values in network.tensors.items():
        assert again.tensors[tensor] == pytest.approx(values, rel=1e-6)


def test_rows_are_numbered_through_all_tensors() -> None:
    layout = WeightLayout(SPECS["sdf"])
    assert np.bincount(layout.rows).tolist() == [3] * 5 + [5] + [5] * 4 + [4] + [4] + [1]
    assert [(part.start, part.stop) for part in layout.rows_of_tensors][:3] == [
        (0, 5),
        (5, 6),
        (6, 10),
    ]
    assert np.bincount(layout.tensors).tolist() == [15, 5, 20, 4, 4, 1]


def test_a_mask_keeps_what_it_says_and_all_biases() -> None:
    layout, mask = WeightLayout(SPECS["sdf"]), everything(SPECS["sdf"])
    assert layout.kept(None) is None
    mask["weight.1"][2, 3] = False
    kept = layout.kept(mask)
    assert kept is not None
    assert kept.sum() == len(kept) - 1
    assert layout.parts(kept)["weight.1"][2, 3] == 0


@pytest.mark.parametrize("step", [1e-9, 0.0123, 1.0, 31.9, 1e6])
def test_a_step_of_four_bits_is_near_and_stays(step: float) -> None:
    near = four_bits(step)
    assert near == pytest.approx(step, rel=1 / 16)
    assert four_bits(near * (1 + 1e-6)) == near
    assert math.frexp(near)[0] * 16 % 1 == 0
