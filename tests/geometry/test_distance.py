"""Distances and signs are the same however they are found."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.geometry.distance import DistanceField
from nispcodec.geometry.reach import reach_of, rim_points, shared_corners
from nispcodec.geometry.solid import build_solid
from nispcodec.geometry.surface_points import laplace_offsets, solid_surface
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import cube, hemisphere, soup

BODIES = {
    "cube": cube((-0.5,) * 3, 1.0),
    "inverted cube": cube((-0.5,) * 3, 1.0)[:, ::-1],
    "two that overlap": np.concatenate([cube((-0.6,) * 3, 0.8), cube((-0.1,) * 3, 0.7)]),
    "cube and card": np.concatenate([cube((-0.5,) * 3, 0.6), 0.3 * hemisphere() + [0.4, 0.4, 0]]),
    "cube without a face": cube((-0.5,) * 3, 1.0)[2:],
}


def field_of(corners: Float64Array) -> DistanceField:
    return DistanceField(build_solid(corners, welded(soup(corners))))


def points_beside(field: DistanceField, count: int, spread: float) -> Float64Array:
    random = np.random.default_rng(0)
    surface, _ = solid_surface(random, field.solid, count)
    return laplace_offsets(random, surface, spread, 1.05)


@pytest.mark.parametrize("name", BODIES)
def test_signs_by_the_closest_wall_are_those_of_the_winding_number(name: str) -> None:
    field = field_of(BODIES[name])
    for spread in (0.003, 0.05, 0.2):
        points = points_beside(field, 3000, spread)
        found = field.closest(points)
        inside = np.abs(field.solid.winding.at(points)) > 0.5
        off_sheets = ~found.sheet
        assert np.array_equal((found.sdf < 0)[off_sheets], inside[off_sheets])


@pytest.mark.parametrize("name", BODIES)
def test_points_moved_towards_the_surface_have_their_share_of_the_distance(name: str) -> None:
    field = field_of(BODIES[name])
    points = points_beside(field, 3000, 0.02)
    moved, found = field.nearer(points, field.closest(points, signed=False), 0.4)
    again = field.closest(moved, signed=False)
    assert found.sdf == pytest.approx(again.sdf, abs=1e-9)
    assert np.abs(found.point - again.point).max() < 1e-6


def test_both_kinds_of_distance_at_once_are_those_of_each() -> None:
    field = field_of(BODIES["cube and card"])
    points = points_beside(field, 1000, 0.05)
    for one, signed in zip(field.both(points), (True, False), strict=True):
        other = field.closest(points, signed)
        for name, values in vars(one).items():
            assert np.array_equal(values, getattr(other, name)), name


def test_rough_winding_numbers_are_on_the_right_side() -> None:
    winding = field_of(BODIES["two that overlap"]).solid.winding
    points = np.random.default_rng(0).uniform(-0.8, 0.8, size=(5000, 3))
    assert np.array_equal(np.abs(winding.about(points)) > 0.5, np.abs(winding.at(points)) > 0.5)


def test_pieces_reach_as_far_as_the_nearest_gap_and_half_as_far_as_the_rim() -> None:
    piece = np.array([[[0.0, 0, 0], [0.03, 0, 0], [0, 0.03, 0]]])
    far, near = np.array([[1.01, 0.01, 0]]), np.array([[0.11, 0.01, 0]])
    size = np.sqrt(0.02**2 + 0.01**2)
    nothing = np.zeros((0, 3))
    assert reach_of(piece, nothing, nothing, 0.0).tolist() == [np.inf]
    assert reach_of(piece, far, nothing, 0.0) == pytest.approx(1 - size)
    assert reach_of(piece, nothing, far, 0.0) == pytest.approx((1 - size) / 2)
    assert reach_of(piece, far, near, 0.2).tolist() == [0.0]


def test_gaps_are_where_hidden_pieces_meet_others_and_rims_are_followed() -> None:
    corners = cube((0, 0, 0), 1.0)
    assert len(shared_corners(corners, np.zeros(12, dtype=bool))) == 0
    assert len(shared_corners(corners, np.arange(12) == 0)) == 3
    points = rim_points(corners, np.array([0]), 0.25)
    ends = corners[0, :2]
    along = np.linalg.norm(points - ends[0], axis=1) / np.linalg.norm(ends[1] - ends[0])
    assert along[0] == 0
    assert np.diff(along).max() <= 0.25
    assert 0.7 < along.max() <= 1


def test_what_was_forgotten_is_answered_as_before() -> None:
    field = field_of(BODIES["cube and card"])
    points = points_beside(field, 1000, 0.05)
    before = field.closest(points)
    field.forget()
    assert "_walls" not in vars(field)
    again = field.closest(points)
    assert all(np.array_equal(getattr(again, name), held) for name, held in vars(before).items())
