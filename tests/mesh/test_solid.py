"""What a signed distance can hold: outer faces, hidden walls, sheets."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.mesh.distance import DistanceField
from nispcodec.mesh.solid import SHELL, area, build_solid
from tests.mesh.shapes import cube, hemisphere


def test_a_closed_body_is_all_outer() -> None:
    solid = build_solid(cube((-0.5, -0.5, -0.5), 1.0))
    assert solid.hidden_share == 0
    assert solid.sheet_share == 0
    assert area(solid.pieces).sum() == pytest.approx(6)
    assert set(solid.parents) == set(range(12))


def test_a_body_inside_another_is_hidden() -> None:
    solid = build_solid(np.concatenate([cube((-0.5,) * 3, 1.0), cube((-0.2,) * 3, 0.4)]))
    assert solid.hidden_share == pytest.approx(0.96 / 6.96)
    assert solid.parents.max() < 12


def test_walls_partly_inside_another_body_are_cut_to_what_shows() -> None:
    one, other = cube((-0.5, -0.3, -0.3), 0.6), cube((-0.1, -0.2, -0.2), 0.4)
    solid = build_solid(np.concatenate([one, other]))
    # The small cube sticks out of the large one by half; its other half and the spot of the
    # large one's wall that it covers are hidden.
    expected = (0.5 * 0.96 + 0.16 / 2 - 0.08 + 0.16) / (6 * 0.36 + 6 * 0.16)
    assert solid.hidden_share == pytest.approx(expected, abs=0.03)


def test_the_inside_of_an_inverted_body_is_inside() -> None:
    inverted = cube((-0.5,) * 3, 1.0)[:, ::-1]
    field = DistanceField(build_solid(inverted))
    assert field.closest(np.array([[0.0, 0, 0], [0.9, 0, 0]])).sdf == pytest.approx([-0.5, 0.4])


def test_a_card_gets_a_thickness() -> None:
    card = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]])
    solid = build_solid(card / 2.0)
    assert solid.sheet_share > 0.95
    heights = np.array([0.0, SHELL, 0.1])
    points = np.column_stack([np.full(3, 0.1), np.full(3, 0.05), heights])
    assert DistanceField(solid).closest(points).sdf == pytest.approx(heights - SHELL)


def test_an_open_bowl_is_a_sheet_without_a_lid() -> None:
    solid = build_solid(hemisphere() - [0, 0, 0.5])
    assert solid.sheet_share == pytest.approx(1)
    below_the_rim = np.array([[0.0, 0.0, -0.3]])
    assert DistanceField(solid).closest(below_the_rim).sdf[0] > 0.5


def test_a_bowl_whose_rim_is_plugged_by_a_body_is_solid() -> None:
    bowl = 0.4 * hemisphere() + [0, 0, 0.45]
    solid = build_solid(np.concatenate([cube((-0.5,) * 3, 1.0), bowl]))
    assert solid.sheet_share == pytest.approx(0, abs=1e-3)
    assert DistanceField(solid).closest(np.array([[0, 0, 0.6]])).sdf[0] < -0.1


def test_distance_is_exact_outside_inside_and_at_corners() -> None:
    field = DistanceField(build_solid(cube((-0.5,) * 3, 1.0)))
    points = np.array([[0, 0, 0.4], [0, 0, 0.75], [0.8, 0.9, 0.5]])
    assert field.closest(points).sdf == pytest.approx([-0.1, 0.25, 0.5])
