"""Which sides meet, and how corners come together around vertices."""

from __future__ import annotations

import numpy as np

from nispcodec.format.mesh.manifold import fans, following, twins
from tests.format.mesh.parts import box, grid


def alike(one: int, other: int) -> int:
    return 0


def test_a_closed_box_has_no_borders_and_one_fan_a_vertex() -> None:
    twin = twins(box().faces, box().sheet, alike)
    assert (twin[twin] == np.arange(36)).all()
    assert len(set(fans(twin).tolist())) == 8


def test_sides_that_meet_run_opposite_ways() -> None:
    flat = grid(3)
    twin = twins(flat.faces, flat.sheet, alike)
    inner = np.flatnonzero(twin >= 0)
    starts = flat.faces.ravel()
    assert (starts[inner] == starts[following(twin[inner])]).all()
    assert (twin < 0).sum() == 12


def test_faces_that_run_the_same_way_do_not_meet() -> None:
    faces = np.array([[0, 1, 2], [0, 1, 3]], np.int32)
    assert (twins(faces, np.zeros(2, np.bool_), alike) == -1).all()


def test_of_four_faces_at_an_edge_those_meet_that_belong_together() -> None:
    faces = np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 0, 5]], np.int32)

    def unlike(one: int, other: int) -> int:
        return abs(one // 3 - other // 3) != 3

    twin = twins(faces, np.zeros(4, np.bool_), unlike)
    assert (twin[0], twin[9], twin[3], twin[6]) == (9, 0, 6, 3)


def test_faces_of_sheets_meet_no_others() -> None:
    flat = grid(1)
    assert (twins(flat.faces, np.array([True, False]), alike) == -1).all()


def test_two_fans_that_touch_in_a_vertex_are_two_points() -> None:
    faces = np.array([[0, 1, 2], [0, 3, 4]], np.int32)
    corners = fans(twins(faces, np.zeros(2, np.bool_), alike))
    assert corners[0] != corners[3]
