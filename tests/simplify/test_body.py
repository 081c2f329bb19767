"""One body against another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.body import Body, placement_of
from nispcodec.simplify.config import CopiesConfig
from tests.simplify.meshes import triangles_of
from tests.simplify.scenes import copied, pebble

CONFIG = CopiesConfig()
MOVED = Placement((0.8, 0.0, 0.0, 0.6), (0.0, 0.9, 0.0), uv_scale=(2.0, 1.0), uv_offset=(0.0, 0.3))
PAIR = triangles_of(copied(pebble(), (Placement(), MOVED)))
FIRST, SECOND = (Body.of(PAIR, np.flatnonzero(PAIR.bodies == number)) for number in (0, 1))


def test_size_and_shape_are_those_of_the_faces() -> None:
    assert FIRST.size == pytest.approx(SECOND.size)
    assert FIRST.shape == pytest.approx(SECOND.shape)
    assert FIRST.dressed.all()


def test_the_placement_is_the_one_that_was_made() -> None:
    found = placement_of(FIRST, SECOND, mirrored=False, config=CONFIG)
    assert found is not None
    assert found.rotation == pytest.approx(MOVED.rotation)
    assert found.offset == pytest.approx(MOVED.offset)
    assert found.uv_scale == pytest.approx(MOVED.uv_scale)
    assert found.uv_offset == pytest.approx(MOVED.uv_offset)


def test_what_is_near_0_or_1_is_said_to_be() -> None:
    found = placement_of(FIRST, SECOND, mirrored=False, config=CONFIG)
    assert found is not None
    assert found.scale == 1.0
    assert found.rotation[1:3] == (0.0, 0.0)
    assert found.uv_scale[1] == 1.0
    assert found.uv_offset[0] == 0.0


def test_corners_in_another_order_are_no_copy() -> None:
    turned = replace(SECOND, order=SECOND.order[:, [1, 2, 0]])
    assert placement_of(FIRST, turned, mirrored=False, config=CONFIG) is None


def test_sheets_and_faces_without_uv_are_like_their_own() -> None:
    for change in (
        {"sheet": PAIR.bodies == 1},
        {"uv_faces": np.where(PAIR.bodies[:, None] == 1, -1, PAIR.uv_faces)},
    ):
        other = replace(SECOND, triangles=replace(PAIR, **change))
        assert placement_of(FIRST, other, mirrored=False, config=CONFIG) is None
