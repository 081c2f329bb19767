"""Vertices moved towards the source: nearer, nothing turned over, borders and seams in place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.curves import border_sides, ends_of, seam_sides
from nispcodec.simplify.errors import Original
from nispcodec.simplify.position_fit import fitted_positions
from nispcodec.simplify.retreat import crosses
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import (
    SMALL_FIT,
    ball,
    bare_ball,
    cards,
    half_dressed_ball,
    sheet,
    triangles_of,
)


def distance(source: Source, triangles: Triangles) -> float:
    original = Original.of(source.triangles, source.tree, 4000, 0)
    return original.errors(triangles.mesh()).distance


@pytest.mark.parametrize("triangles", [ball(), bare_ball(), half_dressed_ball()])
def test_the_surface_comes_much_nearer(triangles: Triangles) -> None:
    source = Source(triangles)
    fewer = collapsed(triangles, 80)
    moved = fitted_positions(source, fewer, SMALL_FIT)
    assert distance(source, moved) < 0.6 * distance(source, fewer)
    assert (moved.faces == fewer.faces).all()


def test_no_vertex_is_sent_far_away() -> None:
    source = Source(ball())
    fewer = collapsed(source.triangles, 40)
    most = 0.5 * distance(source, fewer)
    for far, least, within in ((0.5, 0.0, True), (0.5, 10.0, False), (np.inf, 0.0, False)):
        moved = fitted_positions(source, fewer, replace(SMALL_FIT, far=far, least_far=least))
        assert bool(_off(source, moved).max() <= 1.1 * most) is within


def _off(source: Source, triangles: Triangles) -> Float64Array:
    """How far the vertices of triangles are from a source."""
    nearest = source.tree.closest(triangles.positions).positions
    found: Float64Array = np.linalg.norm(triangles.positions - nearest, axis=1)
    return found


def test_no_face_turns_over() -> None:
    source = Source(ball())
    fewer = collapsed(source.triangles, 60)
    moved = fitted_positions(source, fewer, SMALL_FIT)
    outwards = moved.corners.mean(axis=1)
    assert ((crosses(moved.faces, moved.positions) * outwards).sum(axis=1) > 0).all()


def test_a_seam_stays_where_it_is() -> None:
    source = Source(ball())
    moved = fitted_positions(source, collapsed(source.triangles, 60), SMALL_FIT)
    ends = ends_of(moved, seam_sides(moved))
    assert np.abs(moved.positions[ends][..., 2]).max() < 0.02


def test_a_border_stays_where_it_is() -> None:
    source = Source(sheet())
    moved = fitted_positions(source, collapsed(source.triangles, 60), SMALL_FIT)
    ends = ends_of(moved, border_sides(moved))
    off = np.abs(np.abs(moved.positions[ends.ravel()][:, :2]).max(axis=1) - 1)
    assert off.max() < 0.03


def test_a_moved_corner_comes_back_to_its_crease() -> None:
    source = Source(triangles_of(shapes.box_asset()))
    box = source.triangles
    shaken = box.positions + np.random.default_rng(0).normal(size=box.positions.shape) * 0.05
    moved = fitted_positions(source, replace(box, positions=shaken), replace(SMALL_FIT, rounds=12))
    assert np.abs(moved.positions - box.positions).max() < 0.01


def test_flat_triangles_stay_flat() -> None:
    source = Source(triangles_of(shapes.soup(shapes.grid(8))))
    moved = fitted_positions(source, collapsed(source.triangles, 10), SMALL_FIT)
    assert np.abs(moved.positions[:, 2]).max() < 1e-9


def test_cards_stay_where_they_are() -> None:
    source = Source(cards(40))
    moved = fitted_positions(source, source.triangles, SMALL_FIT)
    assert np.abs(moved.positions - source.triangles.positions).max() < 0.01
