from __future__ import annotations

import numpy as np
import pytest

from nispcodec.infer.space_order import space_order


@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("scale", [0, 1e-30, 1, 1e6])
def test_every_point_comes_once(kind: type[np.floating], scale: float) -> None:
    points = (np.random.default_rng(0).uniform(-1, 1, (500, 3)) * scale).astype(kind)
    assert sorted(space_order(points).tolist()) == list(range(500))
    assert space_order(points[:0]).shape == (0,)
    assert space_order(points[:1]).tolist() == [0]


def test_neighbors_follow_each_other() -> None:
    points = np.random.default_rng(0).uniform(-1, 1, (4000, 3))
    steps = np.linalg.norm(np.diff(points[space_order(points)], axis=0), axis=1)
    assert steps.mean() < 0.25 * np.linalg.norm(np.diff(points, axis=0), axis=1).mean()


def test_cells_of_a_row_follow_in_z_order() -> None:
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.float64)
    assert space_order(corners[::-1]).tolist() == list(range(8))[::-1]
