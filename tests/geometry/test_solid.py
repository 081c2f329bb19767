"""What a signed distance can hold: outer faces, hidden walls, sheets."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import ArrayLike

from nispcodec.core.arrays import Float64Array
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.distance import DistanceField
from nispcodec.geometry.solid import Solid, build_solid
from nispcodec.geometry.triangles import area
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import cube, hemisphere, soup

HALF, THIN, LIFT = SolidConfig.half_thickness, SolidConfig.thin_wall, SolidConfig.sheet_lift
CARD = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]]) / 2
HEIGHTS = np.array([0.0, HALF, 0.1])


def solid_of(corners: Float64Array) -> Solid:
    """The solid of a triangle soup."""
    return build_solid(corners, welded(soup(corners)))


def heights_above(solid: Solid, heights: ArrayLike = HEIGHTS) -> Float64Array:
    """The field at some heights over a place on the card."""
    points = [[0.1, 0.05, height] for height in np.asarray(heights)]
    return DistanceField(solid).closest(np.array(points)).sdf


def back_to_back(gap: float) -> Float64Array:
    """(4, 3, 3): a card that faces up, and one below that faces down."""
    return np.concatenate([CARD + np.array([0, 0, gap]), CARD[:, ::-1]])


def test_a_closed_body_is_all_outer() -> None:
    solid = solid_of(cube((-0.5, -0.5, -0.5), 1.0))
    assert solid.hidden_share == 0
    assert solid.open_surface_share == 0
    assert area(solid.pieces).sum() == pytest.approx(6)
    assert set(solid.parents) == set(range(12))


def test_a_body_inside_another_is_hidden() -> None:
    solid = solid_of(np.concatenate([cube((-0.5,) * 3, 1.0), cube((-0.2,) * 3, 0.4)]))
    assert solid.hidden_share == pytest.approx(0.96 / 6.96)
    assert solid.parents.max() < 12


def test_walls_partly_inside_another_body_are_cut_to_what_shows() -> None:
    one, other = cube((-0.5, -0.3, -0.3), 0.6), cube((-0.1, -0.2, -0.2), 0.4)
    solid = solid_of(np.concatenate([one, other]))
    # The small cube sticks out of the large one by half; its other half and the spot of the
    # large one's wall that it covers are hidden.
    expected = (0.5 * 0.96 + 0.16 / 2 - 0.08 + 0.16) / (6 * 0.36 + 6 * 0.16)
    assert solid.hidden_share == pytest.approx(expected, abs=0.03)


def test_the_inside_of_an_inverted_body_is_inside() -> None:
    inverted = cube((-0.5,) * 3, 1.0)[:, ::-1]
    field = DistanceField(solid_of(inverted))
    assert field.closest(np.array([[0.0, 0, 0], [0.9, 0, 0]])).sdf == pytest.approx([-0.5, 0.4])


def test_a_card_gets_a_thickness() -> None:
    solid = solid_of(CARD)
    assert solid.open_surface_share == 1
    assert heights_above(solid) == pytest.approx(HEIGHTS - HALF, abs=2 * LIFT)


@pytest.mark.parametrize("gap", [0.0, 1e-4, THIN / 2])
def test_two_cards_back_to_back_get_a_thickness(gap: float) -> None:
    solid = solid_of(back_to_back(gap))
    assert solid.open_surface_share == 1
    assert heights_above(solid) == pytest.approx(np.maximum(HEIGHTS - gap, 0) - HALF, abs=2 * LIFT)
    assert heights_above(solid, [gap / 2]) == pytest.approx(gap / 2 - HALF, abs=2 * LIFT)


def test_of_two_faces_back_to_back_the_one_on_the_same_side_is_closest() -> None:
    solid = solid_of(back_to_back(0))
    points = np.array([[0.1, 0.05, z] for z in (0.3, 1e-4, -1e-4, -0.3)])
    found = DistanceField(solid).closest(points).piece
    assert (solid.parents[found] < 2).tolist() == [True, True, False, False]


def test_a_wall_with_an_inside_has_its_own_thickness() -> None:
    solid = solid_of(back_to_back(3 * THIN))
    assert solid.open_surface_share == 0
    assert heights_above(solid, [-0.01, THIN, 0.01]) == pytest.approx([0.01, -THIN, 0.007])


def test_leaves_are_sheets_however_many() -> None:
    random = np.random.default_rng(0)
    turns = np.linalg.qr(random.normal(size=(60, 3, 3)))[0]
    places = random.normal(0, 0.3, (60, 1, 1, 3))
    leaves = (0.25 * np.einsum("nij,mcj->nmci", turns, CARD) + places).reshape(-1, 3, 3)
    solid = solid_of(leaves)
    assert solid.open_surface_share == 1
    assert not DistanceField(solid).inside(random.normal(0, 0.3, (500, 3))).any()


def test_loose_panels_that_enclose_a_room_are_its_walls() -> None:
    panels = cube((-0.5,) * 3, 1.0)
    outwards = panels.reshape(6, 6, 3).mean(axis=1)
    solid = solid_of(panels + 0.004 * np.repeat(outwards, 2, axis=0)[:, None])
    assert solid.open_surface_share == 0
    assert DistanceField(solid).closest(np.zeros((1, 3))).sdf[0] == pytest.approx(-0.502)


def test_an_open_bowl_is_a_sheet_without_a_lid() -> None:
    solid = solid_of(hemisphere() - [0, 0, 0.5])
    assert solid.open_surface_share == pytest.approx(1)
    below_the_rim = np.array([[0.0, 0.0, -0.3]])
    assert DistanceField(solid).closest(below_the_rim).sdf[0] > 0.5


def test_a_bowl_whose_rim_is_plugged_by_a_body_is_solid() -> None:
    bowl = 0.4 * hemisphere() + [0, 0, 0.45]
    solid = solid_of(np.concatenate([cube((-0.5,) * 3, 1.0), bowl]))
    assert solid.open_surface_share == pytest.approx(0, abs=1e-3)
    assert DistanceField(solid).closest(np.array([[0, 0, 0.6]])).sdf[0] < -0.1


def test_distance_is_exact_outside_inside_and_at_corners() -> None:
    field = DistanceField(solid_of(cube((-0.5,) * 3, 1.0)))
    points = np.array([[0, 0, 0.4], [0, 0, 0.75], [0.8, 0.9, 0.5]])
    assert field.closest(points).sdf == pytest.approx([-0.1, 0.25, 0.5])
