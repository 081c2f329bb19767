"""Two faces back to back: each is met from its own side."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.metrics.compare import compare
from nispcodec.metrics.surface import Surface, frame_of
from tests.geometry.shapes import cube, hemisphere, soup

CARD = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0]], [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]]])


def flag(gap: float) -> TexturedMesh:
    """A card that faces up, of u = 0.2, and one below that faces down, of u = 0.7."""
    lift = np.array([0, 0, gap / 2])
    uvs = np.concatenate([np.full((2, 3, 2), 0.2), np.full((2, 3, 2), 0.7)])
    return soup(np.concatenate([CARD + lift, CARD[:, ::-1] - lift]), uvs)


def surface(triangles: Float64Array) -> Surface:
    mesh = soup(triangles)
    return Surface.of(mesh, frame_of(mesh))


def test_twins_have_the_same_corners_the_other_way_round() -> None:
    assert Surface.of(flag(0), frame_of(flag(0))).opposite_faces.tolist() == [2, 3, 0, 1]
    again = surface(np.concatenate([CARD, CARD]).astype(float))
    assert again.opposite_faces.tolist() == [-1] * 4


@pytest.mark.parametrize("body", [cube((-1, -1, -1), 2.0), hemisphere()])
def test_symmetric_bodies_have_none(body: Float64Array) -> None:
    both = np.concatenate([body, (body * [1, 1, -1])[:, ::-1]])
    assert (surface(body).opposite_faces == -1).all()
    assert (surface(both).opposite_faces == -1).all()


def test_the_closest_point_is_on_the_face_that_looks_there() -> None:
    two = Surface.of(flag(0), frame_of(flag(0)))
    points = np.array([[0.1, 0.3, z] for z in (0.5, 1e-3, -1e-3, -0.5)])
    found = two.closest(points)
    assert (found.faces < 2).tolist() == [True, True, False, False]
    assert two.interpolate(found.faces, found.weights) == pytest.approx(points * [1, 1, 0])


def test_a_flag_with_a_thickness_keeps_the_uvs_of_its_sides() -> None:
    original, thick = flag(0), flag(0.008)
    report: dict[str, Any] = compare(original, thick, samples=2000)
    assert report["uv"]["larger"]["mean"] == pytest.approx(0, abs=1e-12)
    radius = frame_of(original).radius
    assert report["geometry"]["larger"]["mean"] == pytest.approx(0.004 / radius)
