"""What a fit starts from is what the decoder can make again."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.initial_weights import BITS
from nispcodec.core.network import NetworkSpec
from nispcodec.train.initialization import coordinates, initial_weights
from nispcodec.train.layout import WeightLayout

SPEC = NetworkSpec(
    (9, 7), 2, conditioning="chart_affine", charts=5, embedding=3, mirror=0b001001, init_seed=4
)


def test_each_tensor_is_in_proportion_to_the_integers_of_the_seed() -> None:
    parts = WeightLayout(SPEC).parts(initial_weights(SPEC))
    for name, integers in SPEC.initial_integers(["weight.1", "bias.0", "embedding"]).items():
        ratio = parts[name].ravel() / (integers.ravel() / 2**BITS)
        assert ratio == pytest.approx(np.full(len(ratio), ratio[0]), rel=1e-5)


def test_frequencies_are_scaled_in_the_first_layer_alone() -> None:
    layout = WeightLayout(SPEC)
    plain, scaled = (layout.parts(initial_weights(SPEC, scale)) for scale in (1.0, 0.5))
    for name in SPEC.shapes:
        factor = 0.5 if name in ("weight.0", "bias.0") else 1.0
        assert np.array_equal(scaled[name], plain[name] * np.float32(factor))


def test_signed_axes_start_unseen_and_tables_of_maps_empty() -> None:
    parts = WeightLayout(SPEC).parts(initial_weights(SPEC))
    assert not parts["weight.0"][:, 3].any()
    assert parts["weight.0"][:, :3].all()
    assert not parts["slopes"].any()
    assert not parts["offsets"].any()


def test_coordinates_are_mirrored_and_signed_ones_follow() -> None:
    points = np.array([[-1, -2, -3]], np.float32)
    assert coordinates(SPEC, points).tolist() == [[1, -2, -3, -1]]
