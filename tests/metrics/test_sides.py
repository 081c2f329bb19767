from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.metrics.sides import Sides, sides_of
from nispcodec.metrics.surface import Surface
from tests.metrics.shapes import joined, moved, plane, sphere

INNER = 320


def sides(mesh: TexturedMesh) -> tuple[Sides, np.ndarray]:
    """The sides of points all over a mesh, and which of them are on its last INNER faces."""
    surface = Surface.of(mesh, Frame((0.0, 0.0, 0.0), 1.0))
    points = surface.sample(400, np.random.default_rng(0))
    return sides_of(surface, points), points.faces >= len(mesh.faces) - INNER


@pytest.mark.parametrize("inside_out", [False, True])
def test_a_body_within_another_is_hidden_whatever_the_winding(inside_out: bool) -> None:
    mesh = joined(sphere(1.0, 2), sphere(0.5, 2))
    if inside_out:
        mesh = dataclasses.replace(mesh, faces=mesh.faces[:, ::-1].copy())
    found, inner = sides(mesh)
    assert 0 < inner.sum() < len(inner)
    np.testing.assert_array_equal(found.hidden, inner)
    np.testing.assert_array_equal(found.outer, ~inner)
    assert not found.sheet.any()


def test_of_two_bodies_that_cross_what_lies_in_the_other_is_hidden() -> None:
    mesh = joined(sphere(1.0, 2), moved(sphere(1.0, 2), (1.0, 0.0, 0.0)))
    surface = Surface.of(mesh, Frame((0.0, 0.0, 0.0), 1.0))
    points = surface.sample(400, np.random.default_rng(0))
    middles = np.array([[1.0, 0, 0], [0.0, 0, 0]])
    other = (points.faces >= INNER).astype(int)
    away = np.linalg.norm(points.positions - middles[other], axis=1)
    clear = np.abs(away - 1) > 0.05
    found = sides_of(surface, points)
    np.testing.assert_array_equal(found.hidden[clear], (away < 1)[clear])


def test_an_open_sheet_is_outside_on_both_sides_until_a_body_holds_it() -> None:
    sheet = moved(plane(), (-0.5, -0.5, 0.0))
    found, _ = sides(sheet)
    assert found.sheet.all()
    assert found.outer.all()
    within = joined(moved(sphere(1.0, 3), (0, 0, 0)), sheet)
    surface = Surface.of(within, Frame((0.0, 0.0, 0.0), 1.0))
    points = surface.sample(400, np.random.default_rng(0))
    on_sheet = points.faces >= len(within.faces) - len(sheet.faces)
    found = sides_of(surface, points)
    assert on_sheet.any()
    assert found.hidden[on_sheet].all()
    assert not found.sheet.any()
