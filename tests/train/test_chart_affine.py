"""Frames: the affine maps that UV networks start from."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.sample_set import SampleSet
from nispcodec.infer.evaluate import evaluate
from nispcodec.train.chart_affine import affine_maps
from nispcodec.train.initialization import initial_weights, place_chart_affine
from nispcodec.train.layout import WeightLayout

SLOPES = np.array([[[1, 2, 3], [0, -1, 0.5]], [[0.2, 0, 0], [0, 0.3, -4]]])
OFFSETS = np.array([[0.1, 0.2], [0.5, -0.5]])
POINTS = np.random.default_rng(0).uniform(-1, 1, (200, 3)).astype(np.float32)
ONE = np.arange(200) % 2
CHARTS = 2 * ONE


def uvs_of(seen: np.ndarray) -> np.ndarray:
    """UVs of charts 0 and 2 of 3: an affine map each of what the network sees."""
    return np.einsum("noc,nc->no", SLOPES[ONE], seen) + OFFSETS[ONE]


@pytest.mark.parametrize("mirror", [0, 0b001, 0b001001], ids=["plain", "mirrored", "sided"])
def test_a_network_of_zeros_answers_with_its_frames(mirror: int) -> None:
    spec = NetworkSpec((4,), 2, conditioning="chart_affine", charts=3, embedding=1, mirror=mirror)
    seen = np.where([mirror >> axis & 1 for axis in range(3)], np.abs(POINTS), POINTS)
    uvs = uvs_of(seen).astype(np.float32)
    layout, weights = WeightLayout(spec), initial_weights(spec)
    samples = SampleSet(POINTS, np.zeros(200, np.float32), CHARTS.astype(np.int32), uvs)
    place_chart_affine(weights, layout, samples, 1e-4)
    tensors = {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()}
    placed = layout.network(weights).tensors
    network = Network(spec, tensors | {name: placed[name] for name in ("slopes", "offsets")})
    assert evaluate(network, POINTS, CHARTS) == pytest.approx(uvs, abs=2e-3)


def test_the_direction_across_a_flat_chart_stays_out_of_it() -> None:
    flat = POINTS.astype(np.float64)
    flat[:, 2] = np.random.default_rng(1).normal(scale=1e-4, size=200)
    slopes, _ = affine_maps(flat, CHARTS, uvs_of(POINTS), 3, 1e-4)
    assert np.abs(slopes.reshape(3, 2, 3)[:, :, 2]).max() < 1


def test_a_chart_without_points_has_no_map() -> None:
    slopes, offsets = affine_maps(POINTS.astype(np.float64), CHARTS, uvs_of(POINTS), 3, 1e-4)
    assert not slopes[1].any()
    assert not offsets[1].any()
