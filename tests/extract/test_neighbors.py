from __future__ import annotations

import numpy as np
import pytest

from nispcodec.extract import neighbors
from nispcodec.extract.neighbors import GroupedPoints, groups_with_neighbors


def brute(asked: GroupedPoints, others: GroupedPoints, reach: float, count: int) -> np.ndarray:
    distances = np.linalg.norm(asked.points[:, None] - others.points, axis=2)
    near = (distances <= reach) & (asked.groups[:, None] != others.groups)
    found = np.zeros(count, bool)
    found[asked.groups[near.any(axis=1)]] = True
    return found


@pytest.mark.parametrize("reach", [0.02, 0.1, 3.0])
def test_the_grid_finds_what_measuring_every_pair_finds(reach: float) -> None:
    rng = np.random.default_rng(0)
    asked = GroupedPoints(rng.uniform(-1, 1, (300, 3)), rng.integers(0, 40, 300))
    others = GroupedPoints(rng.uniform(-1.2, 1.1, (2000, 3)), rng.integers(30, 50, 2000))
    found = groups_with_neighbors(asked, others, reach, 45)
    np.testing.assert_array_equal(found, brute(asked, others, reach, 45))


def test_pairs_are_measured_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    asked = GroupedPoints(rng.uniform(size=(200, 3)), np.arange(200))
    others = GroupedPoints(rng.uniform(size=(500, 3)), np.full(500, 200))
    monkeypatch.setattr(neighbors, "PAIRS", 37)
    found = groups_with_neighbors(asked, others, 0.1, 200)
    np.testing.assert_array_equal(found, brute(asked, others, 0.1, 200))


def test_a_group_is_no_neighbor_of_its_own() -> None:
    points = np.array([[0.0, 0, 0], [0.001, 0, 0], [1, 0, 0]])
    crowd = GroupedPoints(points, np.array([0, 0, 1]))
    assert not groups_with_neighbors(crowd, crowd, 0.01, 2).any()


def test_without_points_there_are_no_neighbors() -> None:
    nothing = GroupedPoints(np.zeros((0, 3)), np.zeros(0, np.int64))
    one = GroupedPoints(np.zeros((1, 3)), np.zeros(1, np.int64))
    assert not groups_with_neighbors(one, nothing, 1.0, 3).any()
    assert not groups_with_neighbors(nothing, one, 1.0, 3).any()
