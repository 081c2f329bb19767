from __future__ import annotations

import numpy as np

from nispcodec.core.mesh_part import Placement
from nispcodec.infer.mesh_queries import PlacedMeshes
from tests.infer.parts import cube, part_of

POINTS = np.random.default_rng(0).uniform(-1, 1, (300, 3)).astype(np.float32)


def test_on_its_own_chart_a_point_has_the_uv_of_the_closest_point() -> None:
    parts = (part_of(cube(), charts=3),)
    meshes = PlacedMeshes(parts)
    charts = meshes.charts(POINTS)
    np.testing.assert_allclose(meshes.uv(POINTS, charts), meshes.uv(POINTS), atol=1e-6)


def test_on_another_chart_it_has_the_uv_of_that_charts_closest_point() -> None:
    """The part's UVs are x and y: of a face at x = 1/2 every UV has u = 1/2."""
    corners = cube()
    part = part_of(corners, charts=12)
    queries = PlacedMeshes((part,))
    right = np.flatnonzero((corners[..., 0] == 0.5).all(axis=1))
    for chart in right:
        uvs = queries.uv(POINTS, np.full(len(POINTS), chart))
        np.testing.assert_allclose(uvs[:, 0], 0.5, atol=1e-4)


def test_copies_have_charts_of_their_own() -> None:
    part = part_of(cube(0.2), charts=2, placements=(Placement(), Placement(offset=(1, 0, 0))))
    queries = PlacedMeshes((part,))
    assert queries.chart_count == 4
    beside = queries.charts(np.array([[0, 0, 0.2], [1, 0, 0.2]], np.float32))
    assert (beside // 2).tolist() == [0, 1]


def test_points_are_projected_to_the_surface() -> None:
    queries = PlacedMeshes((part_of(cube()),))
    landed = queries.project(POINTS)
    np.testing.assert_allclose(np.abs(landed).max(axis=1), 0.5, atol=1e-4)
    assert np.abs(queries.sdf(landed)).max() < 1e-4
    np.testing.assert_allclose(np.linalg.norm(queries.normals(POINTS), axis=1), 1, atol=1e-5)
