"""The order of space: every point once, neighbors near each other."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.geometry.z_order import z_order


@pytest.mark.parametrize("count", [0, 1, 1000])
def test_every_point_comes_once(count: int) -> None:
    points = np.random.default_rng(0).normal(size=(count, 3))
    assert sorted(z_order(points).tolist()) == list(range(count))


def test_points_in_one_place_keep_their_order() -> None:
    assert z_order(np.ones((5, 3))).tolist() == [0, 1, 2, 3, 4]


def test_the_way_along_the_order_is_short() -> None:
    points = np.random.default_rng(0).uniform(size=(4000, 3))
    way = np.linalg.norm(np.diff(points[z_order(points)], axis=0), axis=1)
    assert way.mean() < 0.2 * np.linalg.norm(np.diff(points, axis=0), axis=1).mean()
