from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array
from nispcodec.dataset.hard_examples import error_radii
from nispcodec.train.backend.native.nearest_grid import NearestGrid


def cloud(kind: str) -> Float32Array:
    rng = np.random.default_rng(4)
    points = rng.uniform(-1, 1, (4000, 3))
    if kind == "surface":
        points *= (0.6 + rng.normal(0, 0.01, (4000, 1))) / np.linalg.norm(points, axis=1)[:, None]
    elif kind == "plane":
        points[:, 1] = 0.25
    elif kind == "one place":
        points[:] = 0.5
    elif kind == "lonely":
        points[0] = 40.0
    return points.astype(np.float32)


@pytest.mark.parametrize("floaters", [False, True])
@pytest.mark.parametrize("limit", [0.0, 0.075, 3.0])
@pytest.mark.parametrize("kind", ["volume", "surface", "plane", "one place", "lonely"])
def test_error_radii_are_those_of_the_tree(kind: str, limit: float, floaters: bool) -> None:
    points = cloud(kind)
    sdf = (np.linalg.norm(points, axis=1) - 0.6).astype(np.float32)
    field = (sdf + np.random.default_rng(5).normal(0, 0.05, len(sdf))).astype(np.float32)
    field[::50] = 0
    found = NearestGrid(points).error_radii(sdf, field, limit, floaters)
    wanted = error_radii(points, sdf, field, limit, floaters)
    assert found == pytest.approx(wanted, rel=3e-7)


def test_a_field_of_one_sign_finds_nothing_near() -> None:
    points = cloud("volume")
    sdf = (np.linalg.norm(points, axis=1) - 0.6).astype(np.float32)
    found = NearestGrid(points).error_radii(sdf, np.ones_like(sdf), 0.1)
    assert (found == np.where(sdf < 0, np.float32(0.1), 0)).all()


def test_a_grid_is_for_many_fields() -> None:
    points = cloud("surface")
    grid, rng = NearestGrid(points), np.random.default_rng(6)
    for _ in range(3):
        sdf, field = rng.normal(size=(2, len(points))).astype(np.float32)
        assert grid.error_radii(sdf, field, 0.1) == pytest.approx(
            error_radii(points, sdf, field, 0.1), rel=3e-7
        )


def test_fields_that_are_no_numbers_do_not_crash() -> None:
    points = cloud("volume")
    nothing = np.full(len(points), np.nan, np.float32)
    assert not NearestGrid(points).error_radii(nothing, nothing, 0.1).any()


@pytest.mark.parametrize(
    "points",
    [
        np.zeros((0, 3), np.float32),
        np.zeros((5, 2), np.float32),
        np.zeros((5, 3)),
        np.full((5, 3), np.nan, np.float32),
        np.zeros((10, 3), np.float32)[::2],
    ],
)
def test_points_that_make_no_grid_are_refused(points: Float32Array) -> None:
    with pytest.raises(ValueError, match="points"):
        NearestGrid(points)


def test_fields_of_another_size_are_refused() -> None:
    grid, four, five = NearestGrid(np.zeros((5, 3), np.float32)), *np.zeros((2, 5), np.float32)
    with pytest.raises(ValueError, match="sdf"):
        grid.error_radii(four[:4], five, 0.1)
    with pytest.raises(ValueError, match="field"):
        grid.error_radii(five, five.astype(np.float64), 0.1)
    with pytest.raises(ValueError, match="limit"):
        grid.error_radii(five, five, float("nan"))
