"""Mistakes of a signed field: found on both sides, weighed by how far they reach."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float32Array
from nispcodec.dataset.hard_examples import error_radii

RADIUS = 0.075


def grid() -> np.ndarray:
    """(n, 3) points 0.02 apart in [-0.3, 0.3]^3, around 0 in the middle of a cell."""
    line = np.arange(-0.29, 0.3, 0.02)
    return np.stack(np.meshgrid(line, line, line), axis=3).reshape(-1, 3).astype(np.float32)


def ball(points: Float32Array, center: float, radius: float) -> Float32Array:
    """(n,) signed distance to a ball on the x axis."""
    away: Float32Array = np.linalg.norm(points - [center, 0, 0], axis=1).astype(np.float32)
    return away - np.float32(radius)


def test_a_field_without_mistakes_has_no_reach() -> None:
    sdf = ball(grid(), 0.0, 0.15)
    assert not error_radii(grid(), sdf, np.float32(0.3) * sdf, RADIUS).any()


def test_a_missing_part_weighs_more_than_a_surface_that_is_a_little_off() -> None:
    points = grid()
    whole = np.minimum(ball(points, -0.1, 0.1), ball(points, 0.2, 0.05))
    missing_part = error_radii(points, whole, ball(points, -0.1, 0.1), RADIUS)
    a_little_off = error_radii(points, whole, whole + np.float32(0.01), RADIUS)
    part = ball(points, 0.2, 0.05) < 0
    assert missing_part[part].min() == np.float32(RADIUS)
    assert not missing_part[~part].any()
    assert 0 < a_little_off.max() < RADIUS / 2


def test_a_gap_that_is_filled_counts_like_a_part_that_is_missing() -> None:
    points, sdf = grid(), ball(grid(), 0.0, 0.15)
    missing = error_radii(points, sdf, np.full_like(sdf, 1.0), RADIUS)
    filled = error_radii(points, -sdf, np.full_like(sdf, -1.0), RADIUS)
    np.testing.assert_array_equal(missing > 0, sdf < 0)
    np.testing.assert_array_equal(missing, filled)


@given(st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_reaches_are_of_mistakes_only_and_bounded(count: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    points = random.uniform(-1, 1, (count, 3)).astype(np.float32)
    sdf, field = random.normal(size=(2, count)).astype(np.float32)
    found = error_radii(points, sdf, field, RADIUS)
    assert found.shape == (count,)
    assert ((found > 0) == ((sdf < 0) != (field < 0))).all()
    assert (found <= np.float32(RADIUS)).all()


def test_a_body_far_from_the_surface_weighs_as_much_as_it_is_far() -> None:
    points, sdf = grid(), ball(grid(), -0.2, 0.05)
    speck = ball(points, 0.25, 0.03)
    found = error_radii(points, sdf, np.minimum(sdf, speck), RADIUS, floaters=True)
    np.testing.assert_array_equal(found[speck < 0], sdf[speck < 0])
