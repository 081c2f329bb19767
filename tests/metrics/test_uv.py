from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.surface import Surface
from nispcodec.metrics.uv import uv_at, uv_errors, uv_summary
from tests.metrics.shapes import plane

HALF = 64


def surface_of(mesh: TexturedMesh) -> Surface:
    return Surface.of(mesh, Frame((0.0, 0.0, 0.0), 1.0))


def bare(first: int) -> TexturedMesh:
    """The unit square whose first faces have no UVs."""
    uv_faces = plane().uv_faces.copy()
    uv_faces[:first] = -1
    return dataclasses.replace(plane(), uv_faces=uv_faces)


def test_uvs_are_linear_within_a_face_and_zero_without() -> None:
    surface = surface_of(bare(HALF))
    points = surface.sample(200, np.random.default_rng(0))
    wanted = points.positions[:, :2] * (points.faces >= HALF)[:, None]
    assert 0 < (points.faces >= HALF).sum() < 200
    np.testing.assert_allclose(uv_at(surface, points), wanted, atol=1e-12)


def test_only_pairs_whose_original_has_uvs_count() -> None:
    """What the decoded face lacks is an error: as far as (0, 0) is."""
    whole, part = surface_of(plane()), surface_of(bare(HALF))
    points = whole.sample(200, np.random.default_rng(0))
    pairs = Matches(points, points)
    has_uv = points.faces >= HALF
    np.testing.assert_allclose(uv_errors(part, whole, pairs), np.zeros(has_uv.sum()), atol=1e-12)
    wanted = np.linalg.norm(points.positions[:, :2], axis=1) * ~has_uv
    np.testing.assert_allclose(uv_errors(whole, part, pairs), wanted, atol=1e-12)
    assert uv_errors(surface_of(bare(2 * HALF)), whole, pairs).shape == (0,)


def test_an_error_is_the_distance_in_the_atlas() -> None:
    mesh = plane()
    moved = dataclasses.replace(mesh, uvs=mesh.uvs + np.array([0.3, -0.4]))
    points = surface_of(mesh).sample(50, np.random.default_rng(0))
    errors = uv_errors(surface_of(mesh), surface_of(moved), Matches(points, points))
    np.testing.assert_allclose(errors, 0.5)


def test_a_summary_tells_a_few_large_errors_from_many_small_ones() -> None:
    errors = np.array([0.0] * 90 + [1.0] * 10)
    assert uv_summary(errors) == pytest.approx({"mean": 0.1, "median": 0.0, "p99": 1.0})
