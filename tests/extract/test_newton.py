from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import NetworkSpec
from nispcodec.extract.newton import onto_surface
from nispcodec.infer.evaluate import evaluate
from tests import tiny


def points(count: int, seed: int = 0) -> Float32Array:
    return np.random.default_rng(seed).uniform(-0.9, 0.9, (count, 3)).astype(np.float32)


def test_points_beside_a_face_reach_it_straight_in_one_step() -> None:
    """Where the field is a distance, one step along the normal is all."""
    face = np.array([[0.3, 0.3, 0.2], [-0.4, 0.2, 0.2]], np.float32)
    normals = np.sign(face) / np.float32(np.sqrt(3))
    beside = (face + 0.03 * normals).astype(np.float32)
    moved = onto_surface(tiny.octahedron(), beside, 0.1, steps=1)
    np.testing.assert_allclose(moved, face, atol=1e-6)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("steps", [1, 5])
def test_no_point_gets_farther_from_zero_or_moves_too_far(seed: int, steps: int) -> None:
    """Whatever the field is: this one is noise."""
    network = tiny.random_network(NetworkSpec((8, 8), 1, w0=10.0), seed)
    start = points(300, seed)
    moved = onto_surface(network, start, 0.02, steps)
    assert (moved.shape, moved.dtype) == (start.shape, start.dtype)
    assert (np.abs(moved - start) <= 0.02 + 1e-6).all()
    before, after = (np.abs(evaluate(network, each)[:, 0]) for each in (start, moved))
    assert (after <= before + 1e-6).all()
    assert after.mean() < before.mean()


def test_points_stay_where_the_field_is_flat_or_no_step_is_asked_for() -> None:
    flat = tiny.relu_network([(np.zeros((2, 3)), np.zeros(2)), (np.zeros((1, 2)), np.ones(1))])
    start = points(50)
    np.testing.assert_array_equal(onto_surface(flat, start, 1.0, 3), start)
    np.testing.assert_array_equal(onto_surface(tiny.octahedron(), start, 1.0, 0), start)


def test_no_points_and_points_that_are_kept() -> None:
    assert onto_surface(tiny.octahedron(), points(0), 0.1, 2).shape == (0, 3)
    start = points(20)
    before = start.copy()
    onto_surface(tiny.octahedron(), start, 0.1, 2)
    np.testing.assert_array_equal(start, before)
