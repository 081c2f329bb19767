"""Similarities come back from points that they moved."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.mesh_part import Placement
from nispcodec.core.placing import placed_points
from nispcodec.simplify.similarity import similarity
from tests.simplify.scenes import PLACES

HALF_TURN = Placement((0.0, 0.0, 1.0, 0.0), (3.0, 2.0, 1.0), scale=7.0)


@pytest.mark.parametrize("place", [*PLACES, HALF_TURN])
@pytest.mark.parametrize("flat", [False, True])
def test_points_come_to_where_they_were_moved(place: Placement, flat: bool) -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    points[:, 2] *= not flat
    moved = placed_points(place, points)
    found = similarity(points, moved, place.mirrored)
    np.testing.assert_allclose(placed_points(found, points), moved, atol=1e-9)
    assert found.scale == pytest.approx(place.scale)
    assert np.linalg.norm(found.rotation) == pytest.approx(1)


def test_a_reflection_is_none_unless_asked_for() -> None:
    points = np.random.default_rng(0).normal(size=(20, 3))
    mirrored = points * [-1, 1, 1]
    assert np.abs(placed_points(similarity(points, mirrored, False), points) - mirrored).max() > 0.1


def test_a_single_spot_is_moved() -> None:
    spot = np.ones((3, 3))
    found = similarity(spot, spot + 1, False)
    np.testing.assert_allclose(placed_points(found, spot), spot + 1, atol=1e-12)
    assert found.scale == 1
