"""Frames: the affine maps that UV networks start from."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.decode.evaluate import evaluate
from nispcodec.fit.frames import affine_maps
from nispcodec.mesh.sample_set import SampleSet
from nispcodec.network import Network, NetworkSpec

SLOPES = np.array([[[1, 2, 3], [0, -1, 0.5]], [[0.2, 0, 0], [0, 0.3, -4]]])
OFFSETS = np.array([[0.1, 0.2], [0.5, -0.5]])


def samples(mirror: int) -> SampleSet:
    """Points of charts 0 and 2 of 3, whose UVs are an affine map each of what the network sees."""
    points = np.random.default_rng(0).uniform(-1, 1, (200, 3))
    seen = np.where([mirror >> axis & 1 for axis in range(3)], np.abs(points), points)
    one = np.arange(200) % 2
    uv = np.einsum("noc,nc->no", SLOPES[one], seen) + OFFSETS[one]
    return SampleSet(
        points.astype(np.float32),
        np.zeros(200, np.float32),
        (2 * one).astype(np.int32),
        uv.astype(np.float32),
    )


@pytest.mark.parametrize("mirror", [0, 0b001, 0b001001], ids=["plain", "mirrored", "sided"])
def test_a_network_of_zeros_answers_with_its_frames(mirror: int) -> None:
    spec = NetworkSpec((4,), 2, conditioning="frames", charts=3, embedding=1, mirror=mirror)
    given = samples(mirror)
    tensors = {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()}
    tensors["slopes"], tensors["offsets"] = affine_maps(spec, given)
    found = evaluate(Network(spec, tensors), given.points, given.chart)
    assert found == pytest.approx(given.uv, abs=2e-3)


def test_the_direction_across_a_flat_chart_stays_out_of_it() -> None:
    spec = NetworkSpec((4,), 2, conditioning="frames", charts=3, embedding=1)
    given = samples(0)
    given.points[:, 2] = np.random.default_rng(1).normal(scale=1e-4, size=200)
    slopes, _ = affine_maps(spec, given)
    assert np.abs(slopes.reshape(3, 2, 3)[:, :, 2]).max() < 1


def test_a_chart_without_samples_has_no_frame() -> None:
    spec = NetworkSpec((4,), 2, conditioning="frames", charts=3, embedding=1)
    slopes, offsets = affine_maps(spec, samples(0))
    assert not slopes[1].any()
    assert not offsets[1].any()
