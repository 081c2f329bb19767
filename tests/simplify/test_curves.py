"""Borders and seams of triangles."""

from __future__ import annotations

import numpy as np

from nispcodec.simplify.curves import Segments, border_sides, ends_of, seam_sides
from tests.simplify.meshes import ball, half_dressed_ball, sheet


def test_the_equator_is_the_seam() -> None:
    triangles = ball()
    ends = ends_of(triangles, seam_sides(triangles))
    assert len(ends) == 28
    assert np.abs(triangles.positions[ends][..., 2]).max() < 1e-12
    assert not border_sides(triangles).any()


def test_where_uvs_end_is_a_seam() -> None:
    triangles = half_dressed_ball()
    ends = ends_of(triangles, seam_sides(triangles))
    assert np.abs(triangles.positions[ends][..., 2]).max() < 1e-12


def test_a_sheet_has_a_border_and_no_seam() -> None:
    triangles = sheet(5)
    assert len(ends_of(triangles, border_sides(triangles))) == 20
    assert not seam_sides(triangles).any()


def test_closest_points_on_segments() -> None:
    segments = Segments(np.array([[0.0, 0, 0], [0, 2, 0]]), np.array([[1.0, 0, 0], [1, 2, 0]]))
    assert segments.length == 2
    which, shares, places = segments.closest(np.array([[0.25, 0.5, 0], [3.0, 2, 1]]))
    assert which.tolist() == [0, 1]
    assert np.allclose(shares, [[0.75, 0.25], [0.0, 1.0]])
    assert np.allclose(places, [[0.25, 0.0, 0.0], [1.0, 2.0, 0.0]])


def test_points_are_spread_along_segments() -> None:
    segments = Segments(np.zeros((2, 3)), np.array([[1.0, 0, 0], [0, 3, 0]]))
    points = segments.spread(400, np.random.default_rng(0))
    assert (points[:, 1] > 0).sum() == 300
    assert points.max() <= 3
