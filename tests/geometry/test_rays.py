from __future__ import annotations

import numpy as np

from nispcodec.geometry.rays import leaves, ways_beside
from tests.geometry.shapes import cube

BOX = cube((-1, -1, -1), 2.0)


def test_rays_leave_where_nothing_is_before_them() -> None:
    ways = np.array([[1.0, 0.2, 0.1], [0.0, 0.1, 1.0]])
    assert leaves(BOX, np.zeros((2, 3)), ways).tolist() == [False, False]
    assert leaves(BOX, np.full((2, 3), 3.0), ways).tolist() == [True, True]
    topless = BOX[~(BOX[..., 2] == 1).all(axis=1)]
    assert leaves(topless, np.zeros((2, 3)), ways).tolist() == [False, True]
    assert leaves(BOX, np.zeros((0, 3)), ways[:0]).shape == (0,)


def test_small_triangles_are_in_the_way_too() -> None:
    ways = np.random.default_rng(0).normal(size=(1000, 3))
    assert not leaves(1e-4 * BOX, np.zeros((1000, 3)), ways).any()


def test_ways_lie_about_the_way_that_is_faced() -> None:
    facing = np.tile([0.0, 0.0, 1.0], (4000, 1))
    ways = ways_beside(facing, np.random.default_rng(0))
    np.testing.assert_allclose(np.linalg.norm(ways, axis=1), 1, atol=1e-12)
    assert (ways[:, 2] >= 0).all()
    # By the cosine: its mean over the hemisphere is two thirds.
    np.testing.assert_allclose(ways.mean(axis=0), [0, 0, 2 / 3], atol=0.03)
