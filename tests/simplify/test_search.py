"""The smallest candidate within errors."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.simplify.search import best_for, kept_whole
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import (
    ball,
    bare_ball,
    cards,
    half_dressed_ball,
    sheet,
    simplifier,
    triangles_of,
)


@pytest.mark.parametrize("triangles", [ball(), bare_ball(), half_dressed_ball(), sheet()])
def test_the_best_is_within_the_errors_and_smaller_than_all(triangles: Triangles) -> None:
    made = simplifier(triangles)
    whole = kept_whole(made, 0.01, 0.02)
    best = best_for(made, 0.01, 0.02)
    assert whole is not None
    assert best is not None
    assert best.errors.within(0.01, 0.02)
    assert best.size < 0.7 * whole.size


def test_tight_errors_take_all_faces() -> None:
    best = best_for(simplifier(ball(6)), 2e-6, 1e-4)
    assert best is not None
    assert best.faces == len(ball(6))


def test_no_error_at_all_cannot_be_had() -> None:
    assert best_for(simplifier(ball(4)), 1e-12, 1e-12) is None


def test_cards_keep_their_area() -> None:
    best = best_for(simplifier(cards(60)), 0.01, 0.05)
    assert best is not None
    assert best.faces > 60


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_mesh_of_few_faces_is_kept(count: int) -> None:
    few = triangles_of(shapes.soup(shapes.cube((-0.5, -0.5, -0.5), 1.0)[:count]))
    best = best_for(simplifier(few), 1e-3, 1e-2)
    assert best is not None
    assert best.faces == count


def test_a_flat_plane_needs_two_faces() -> None:
    best = best_for(simplifier(triangles_of(shapes.soup(shapes.grid(10)))), 1e-3, 3e-3)
    assert best is not None
    assert best.faces <= 20


def test_edges_of_many_faces_are_no_problem() -> None:
    fans = shapes.grid(4)
    upright = fans[..., [2, 1, 0]] + 0.0
    both = triangles_of(shapes.soup(np.concatenate([fans, upright])))
    best = best_for(simplifier(both), 5e-3, 0.5)
    assert best is not None
    assert best.errors.distance <= 5e-3


def test_uvs_are_not_blurred_where_seams_make_the_error() -> None:
    best = best_for(simplifier(ball()), 0.05, 0.5)
    assert best is not None
    assert best.uv_bits >= 8


def test_errors_beyond_the_size_of_the_mesh_leave_something() -> None:
    best = best_for(simplifier(ball(6)), 10.0, 10.0)
    assert best is not None
    assert best.faces >= 1
    assert best.errors.distance < 10
