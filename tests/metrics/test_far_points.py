from __future__ import annotations

import numpy as np

from nispcodec.metrics.far_points import FAR, FarPoints
from nispcodec.metrics.surface import Surface
from tests.geometry.shapes import grid, soup


def test_the_share_is_that_of_points_further_away() -> None:
    mesh = soup(grid())
    points = Surface(mesh, mesh.positions).sample(1000, np.random.default_rng(0))
    found = FarPoints.of(mesh, points, np.where(points.positions[:, 0] > 0.5, 2 * FAR, FAR / 2))
    assert found.share == (points.positions[:, 0] > 0.5).mean()
    assert found.positions[:, 0].min() > 0.5
    assert found.in_larger(0.5).share == found.share / 2
    assert FarPoints().share == 0


def test_the_largest_place_is_where_most_points_hang_together() -> None:
    few, many = np.linspace(0, 0.1, 5), np.linspace(0, 0.2, 30)
    positions = np.zeros((35, 3))
    positions[:, 0] = [*(-1 + few), *(0.5 + many)]
    materials = np.array([0] * 5 + [2] * 30, np.int32)
    place = FarPoints(100, positions, materials).largest
    assert np.allclose(place.center, [0.6, 0, 0])
    assert np.allclose(place.extent, [0.2, 0, 0])
    assert place.material == 2
