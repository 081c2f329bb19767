from __future__ import annotations

import numpy as np
import pytest

from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import NOTHING, far_angles, multipoles
from nispcodec.infer.triangles import solid_angles, triangle_rows
from tests.infer.parts import soup

FAR = 3.0


def test_the_error_falls_with_the_third_power_of_the_distance() -> None:
    """Of what falls with the second: that is what the first two terms of the series leave."""
    corners = soup(8)
    rows = multipoles(MeshTree.of(corners, np.zeros(8, np.bool_)))[0][0, :, 0]
    ways = np.random.default_rng(1).normal(size=(3, 50))
    ways /= np.linalg.norm(ways, axis=0)

    def error(radii: float) -> float:
        points = rows[:3, None] + ways * radii * np.sqrt(rows[3])
        exact = solid_angles(triangle_rows(corners)[:, :, None], points[:, None]).sum(axis=0)
        return float(np.abs(far_angles(rows[:, None], points)[0] - exact).max())

    assert error(FAR) < 0.01
    assert error(2 * FAR) < error(FAR) / 2**3
    assert error(4 * FAR) < error(FAR) / 2**6


def test_the_radius_reaches_the_farthest_corner() -> None:
    corners = soup(8)
    rows = multipoles(MeshTree.of(corners, np.zeros(8, np.bool_)))[0][0, :, 0]
    off = np.linalg.norm(corners.reshape(-1, 3) - rows[:3], axis=1)
    assert np.sqrt(rows[3]) == pytest.approx(off.max(), rel=1e-5)


def test_sheets_and_empty_places_count_for_nothing() -> None:
    corners = soup(20)
    for level in multipoles(MeshTree.of(corners, np.ones(20, np.bool_))):
        assert (level[:, 3] == NOTHING).all()
        assert not level[:, 4:].any()
    solid = np.arange(20) < 10
    with_sheet = multipoles(MeshTree.of(corners, ~solid))[0]
    without = multipoles(MeshTree.of(corners[solid], np.zeros(10, np.bool_)))[0]
    np.testing.assert_allclose(
        with_sheet[:, 4:7].sum(axis=(0, 2)), without[:, 4:7].sum(axis=(0, 2)), atol=1e-7
    )
