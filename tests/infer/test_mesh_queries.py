from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.mesh_part import Placement
from nispcodec.infer.mesh_queries import PlacedMeshes
from tests.infer.parts import cube, part_of, soup, sphere


def scattered(count: int, seed: int = 0) -> Float64Array:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3))


def distance_to_box(points: Float64Array, half: float) -> Float64Array:
    off = np.abs(points) - half
    outside: Float64Array = np.linalg.norm(np.maximum(off, 0), axis=1)
    return outside + np.minimum(off.max(axis=1), 0)


def test_a_cube_is_a_box() -> None:
    points = scattered(5000)
    sdf = PlacedMeshes((part_of(cube()),)).sdf(points)
    np.testing.assert_allclose(sdf, distance_to_box(points, 0.5), atol=2e-5)
    assert sdf.dtype == np.float32


def test_a_cube_with_its_faces_inside_out_is_the_same() -> None:
    points = scattered(2000)
    turned = PlacedMeshes((part_of(cube()[:, ::-1]),))
    np.testing.assert_allclose(turned.sdf(points), distance_to_box(points, 0.5), atol=2e-5)
    on_it = np.array([[0.5, 0.1, 0.2], [0.1, -0.5, 0.2]])
    np.testing.assert_allclose(turned.normals(on_it), [[1, 0, 0], [0, -1, 0]], atol=1e-6)


def test_a_sheet_has_no_inside() -> None:
    points = scattered(2000)
    sdf = PlacedMeshes((part_of(cube(), sheet=True),)).sdf(points)
    np.testing.assert_allclose(sdf, np.abs(distance_to_box(points, 0.5)), atol=2e-5)


def test_bodies_that_overlap_are_one_inside() -> None:
    points = scattered(5000)
    first, second = part_of(cube(0.8, (0.1, 0, 0))), part_of(cube(0.8, (-0.1, 0, 0)))
    sdf = PlacedMeshes((first, second)).sdf(points)
    inside = np.all(np.abs(points) < [0.5, 0.4, 0.4], axis=1)
    clear = np.flatnonzero(np.abs(sdf) > 1e-4)
    np.testing.assert_array_equal(sdf[clear] < 0, inside[clear])


def test_a_body_may_lack_faces_where_another_covers_them() -> None:
    lower, upper = cube(0.5, (0, 0, -0.2)), cube(0.4, (0, 0, 0.1))
    hidden = (np.abs(upper[:, :, 2] - (-0.1)) < 1e-9).all(axis=1)
    assert hidden.sum() == 2
    points = scattered(5000)
    points = points[np.abs(distance_to_box(points - [0, 0, -0.2], 0.25)) > 0.03]
    sdf = PlacedMeshes((part_of(lower), part_of(upper[~hidden]))).sdf(points)
    inside = np.minimum(
        distance_to_box(points - [0, 0, -0.2], 0.25), distance_to_box(points - [0, 0, 0.1], 0.2)
    )
    clear = np.abs(inside) > 1e-3
    np.testing.assert_array_equal((sdf < 0)[clear], (inside < 0)[clear])


def test_normals_are_the_gradient() -> None:
    placed = PlacedMeshes((part_of(sphere(30)),))
    points = scattered(500).astype(np.float32)
    points = points[np.linalg.norm(points, axis=1) > 0.1]
    outwards = points / np.linalg.norm(points, axis=1, keepdims=True)
    assert ((placed.normals(points) * outwards).sum(axis=1) > 0.99).all()
    found = placed.closest(points)
    np.testing.assert_allclose((placed.normals(found.point) * outwards).sum(axis=1), 1, atol=0.01)
    np.testing.assert_allclose(np.linalg.norm(placed.normals(points), axis=1), 1, atol=1e-6)


def test_uvs_and_charts_are_those_of_the_closest_point() -> None:
    part = part_of(sphere(20), charts=3)
    part = replace(
        part,
        chart_has_uv=np.array([True, True, False]),
        uv_faces=np.where(part.face_charts[:, None] == 2, -1, part.uv_faces).astype(np.int32),
    )
    placed = PlacedMeshes((part,))
    points = scattered(1000)
    found, charts = placed.closest(points), placed.charts(points)
    np.testing.assert_array_equal(charts, part.face_charts[found.face])
    expected = np.where(charts[:, None] == 2, 0, found.point[:, :2])
    np.testing.assert_allclose(placed.uv(points), expected, atol=1e-5)


def test_on_charts_that_are_told_it_is_the_closest_of_their_triangles() -> None:
    corners = soup(60)
    part = part_of(corners, charts=3)
    part = replace(
        part,
        chart_materials=np.zeros(4, np.int32),
        chart_has_uv=np.ones(4, np.bool_),
    )
    placed, points = PlacedMeshes((part,)), scattered(300)
    charts = np.random.default_rng(1).integers(0, 4, 300)
    found = placed.closest(points, charts)
    for chart in range(3):
        alone = PlacedMeshes((part_of(placed.triangles.corners[part.face_charts == chart]),))
        rows = charts == chart
        np.testing.assert_allclose(
            found.distance[rows], alone.closest(points[rows]).distance, atol=1e-4
        )
        assert (part.face_charts[found.face[rows]] == chart).all()
    assert np.isinf(found.distance[charts == 3]).all()
    np.testing.assert_allclose(placed.uv(points, charts), found.point[:, :2], atol=1e-5)


def test_copies_have_charts_of_their_own() -> None:
    copies = (
        Placement(offset=(0.5, 0, 0), scale=0.5),
        Placement(
            offset=(-0.5, 0, 0),
            scale=0.5,
            uv_scale=(2, 1),
            uv_offset=(0, 3),
            materials=np.array([7, 8], np.int32),
        ),
    )
    part = part_of(sphere(10), charts=2)
    placed = PlacedMeshes((replace(part, placements=copies), part_of(cube(0.2), charts=1)))
    assert placed.chart_materials.tolist() == [0, 1, 7, 8, 0]
    assert placed.chart_has_uv.tolist() == [True] * 5
    assert set(placed.charts(np.array([[1.0, 0, 0]] * 3)).tolist()) <= {0, 1}
    assert placed.charts(np.array([[-1.0, 0, 0.0]]))[0] in (2, 3)
    assert placed.charts(np.array([[0.0, 0, 0.0]])).tolist() == [4]
    first, second = placed.uv(np.array([[0.5, 0, 0.4], [-0.5, 0, 0.4]]))
    np.testing.assert_allclose(second, first * [2, 1] + [0, 3], atol=1e-5)


def test_without_points_or_triangles_there_are_answers_all_the_same() -> None:
    none, some = PlacedMeshes(()), PlacedMeshes((part_of(cube()),))
    points = scattered(3)
    assert np.isinf(none.sdf(points)).all()
    assert np.isinf(none.closest(points).distance).all()
    for answer in (none.normals(points), none.uv(points), none.charts(points)):
        assert len(answer) == 3
        assert not answer.any()
    for placed in (none, some):
        assert placed.sdf(points[:0]).shape == (0,)
        assert placed.normals(points[:0]).shape == (0, 3)
        assert placed.uv(points[:0]).shape == (0, 2)
        assert placed.closest(points[:0]).point.shape == (0, 3)


@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_triangles_without_area_make_no_nan(kind: type[np.floating]) -> None:
    line = np.array([[[0, 0, 0], [1, 0, 0], [0.5, 0, 0]], [[0, 0, 0]] * 3, cube()[0]])
    placed = PlacedMeshes((part_of(np.concatenate([line, line[:, ::-1]])),))
    points = np.concatenate([scattered(100), line.reshape(-1, 3)]).astype(kind)
    found = placed.closest(points)
    for answer in (placed.sdf(points), placed.normals(points), placed.uv(points), found.point):
        assert np.isfinite(answer).all()
    np.testing.assert_allclose(found.barycentric.sum(axis=1), 1)
    assert (found.barycentric >= 0).all()
