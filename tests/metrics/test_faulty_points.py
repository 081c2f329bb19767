from __future__ import annotations

import numpy as np

from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.metrics.surface import Surface
from tests.geometry.shapes import grid, soup


def test_the_share_is_that_of_the_faulty_points() -> None:
    mesh = soup(grid())
    points = Surface(mesh, mesh.positions).sample(1000, np.random.default_rng(0))
    found = FaultyPoints.of(mesh, points, points.positions[:, 0] > 0.5)
    assert found.share == (points.positions[:, 0] > 0.5).mean()
    assert found.positions[:, 0].min() > 0.5
    assert found.in_larger(0.5).share == found.share / 2
    assert FaultyPoints().share == 0


def test_the_largest_place_is_where_most_points_hang_together() -> None:
    few, many = np.linspace(0, 0.1, 5), np.linspace(0, 0.2, 30)
    positions = np.zeros((35, 3))
    positions[:, 0] = [*(-1 + few), *(0.5 + many)]
    materials = np.array([0] * 5 + [2] * 30, np.int32)
    place = FaultyPoints(100, positions, materials).largest
    assert np.allclose(place.center, [0.6, 0, 0])
    assert np.allclose(place.extent, [0.2, 0, 0])
    assert place.material == 2
