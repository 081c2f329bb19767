"""What is simplified: corners that are the same are one, whatever the file says."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.document import Frame
from nispcodec.core.errors import MeshError
from nispcodec.simplify.triangles import Triangles, joined, side_numbers
from tests.geometry import shapes
from tests.simplify.meshes import UNIT, ball, bare_ball, cards, half_dressed_ball, sheet


def test_a_soup_becomes_connected() -> None:
    box = Triangles.of(shapes.box_asset(), UNIT)
    assert len(box) == 12
    assert len(box.positions) == 8
    assert len(box.uvs) == 24
    assert box.bodies.max() == 0
    assert box.patches.max() == 5


def test_positions_are_in_the_normalized_frame() -> None:
    mesh = shapes.box_asset()
    box = Triangles.of(mesh, Frame((0.0, 0.0, 1.0), 2.0))
    assert np.allclose(box.corners, (mesh.corners - [0, 0, 1]) / 2)
    assert np.allclose(box.corner_uvs, mesh.corner_uvs)


def test_bodies_with_a_border_are_sheets() -> None:
    assert sheet().sheet.all()
    assert not ball().sheet.any()


def test_sheets_can_be_told() -> None:
    mesh = shapes.box_asset()
    told = np.arange(12) < 2
    assert (Triangles.of(mesh, UNIT, sheet=told).sheet == told).all()


def test_some_of_the_faces() -> None:
    mesh = shapes.box_asset()
    chosen = np.arange(12) >= 8
    part = Triangles.of(mesh, UNIT, chosen=chosen)
    assert len(part) == 4
    assert np.allclose(part.corners, mesh.corners[chosen])
    assert (part.materials == 1).all()


def test_no_faces_are_an_error_that_names_the_mesh() -> None:
    with pytest.raises(MeshError, match="mesh: expected faces to simplify, found none"):
        Triangles.of(shapes.box_asset(), UNIT, chosen=np.zeros(12, np.bool_))


def test_faces_whose_corners_fall_together_are_left_out() -> None:
    corners = shapes.cube((-1, -1, -1), 2.0)
    corners[0, 1] = corners[0, 0]
    assert len(Triangles.of(shapes.soup(corners), UNIT)) == 11


def test_faces_without_uv_stay_so() -> None:
    assert not bare_ball().has_uv.any()
    half = half_dressed_ball()
    assert 0 < half.has_uv.sum() < len(half)
    assert half.mesh().has_uv.sum() == half.has_uv.sum()


def test_every_card_is_a_body() -> None:
    assert cards(50).bodies.max() == 49


def test_sides_of_two_faces_share_a_number() -> None:
    edges = side_numbers(np.array([[0, 1, 2], [2, 1, 3]]))
    assert edges[0, 1] == edges[1, 0]
    assert len(np.unique(edges)) == 5


def test_joined_triangles_are_both() -> None:
    first, second = bare_ball(4), ball(4)
    both = joined(first, second)
    assert np.allclose(both.corners, np.concatenate([first.corners, second.corners]))
    assert np.allclose(both.corner_uvs, np.concatenate([first.corner_uvs, second.corner_uvs]))
    assert both.has_uv.sum() == len(second)
    assert both.bodies.max() == 1
