from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float64Array
from nispcodec.infer.triangles import (
    closest_weights,
    solid_angles,
    squared_distances,
    triangle_rows,
)
from tests.infer.parts import cube, points_about, soup, sphere

NUMBER = st.integers(-8, 8).map(lambda whole: whole / 4)
POINT = st.tuples(NUMBER, NUMBER, NUMBER)


def of_samples(corners: Float64Array, point: Float64Array) -> float:
    """Squared distance of a point from the nearest of many points of a triangle."""
    steps = np.linspace(0, 1, 61)
    v, w = (each.ravel() for each in np.meshgrid(steps, steps))
    some = v + w <= 1 + 1e-9
    weights = np.stack([1 - v - w, v, w], axis=1)[some]
    return float((((weights @ corners) - point) ** 2).sum(axis=1).min())


@given(st.tuples(POINT, POINT, POINT), POINT)
def test_the_distance_is_the_least_of_all_points(
    triangle: tuple[tuple[float, ...], ...], point: tuple[float, ...]
) -> None:
    corners, asked = np.array(triangle), np.array(point)
    found = float(squared_distances(triangle_rows(corners[None])[:, 0], asked))
    sampled = of_samples(corners, asked)
    assert np.isfinite(found)
    assert found <= sampled + 1e-12
    assert np.sqrt(sampled) - np.sqrt(found) < 0.11


@given(st.tuples(POINT, POINT, POINT), POINT)
def test_weights_lead_to_the_closest_point(
    triangle: tuple[tuple[float, ...], ...], point: tuple[float, ...]
) -> None:
    corners, asked = np.array(triangle), np.array(point)
    rows = triangle_rows(corners[None])
    weights = closest_weights(rows, asked[:, None])[:, 0]
    assert (weights >= 0).all()
    assert abs(weights.sum() - 1) < 1e-12
    squared = ((weights @ corners - asked) ** 2).sum()
    np.testing.assert_allclose(squared, squared_distances(rows[:, 0], asked), atol=1e-12)


@given(st.tuples(POINT, POINT, POINT, POINT), POINT)
def test_triangles_with_a_common_edge_are_as_far_where_that_is_closest(
    corners: tuple[tuple[float, ...], ...], point: tuple[float, ...]
) -> None:
    a, b, c, d = (np.array(each) / 3 for each in corners)
    both = triangle_rows(np.array([[a, b, c], [b, a, d]]))
    asked = np.repeat(np.array(point)[:, None] * 0.7, 2, axis=1)
    weights = closest_weights(both, asked)
    if (weights[2] == 0).all():
        first, second = squared_distances(both, asked)
        assert first == second


def test_a_closed_surface_is_all_around_a_point_inside_and_nothing_outside() -> None:
    inside, outside = np.zeros((3, 1)), np.full((3, 1), 0.7)
    for corners in (cube(), sphere(9)):
        rows = triangle_rows(corners)
        np.testing.assert_allclose(solid_angles(rows, inside).sum(), 4 * np.pi)
        np.testing.assert_allclose(solid_angles(rows, outside).sum(), 0, atol=1e-12)
        np.testing.assert_allclose(
            solid_angles(triangle_rows(corners[:, ::-1]), inside).sum(), -4 * np.pi
        )


def test_a_face_of_a_cube_is_a_sixth_of_everything_from_its_center() -> None:
    angles = solid_angles(triangle_rows(cube()), np.zeros((3, 1)))
    np.testing.assert_allclose(angles.reshape(6, 2).sum(axis=1), 4 * np.pi / 6)


def test_no_angle_from_the_plane_of_a_triangle_and_none_without_area() -> None:
    flat = triangle_rows(np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]))
    for point in ([0.2, 0.2, 0], [0, 0, 0], [0.5, 0, 0], [3, 3, 0]):
        assert solid_angles(flat, np.array(point, np.float64)[:, None]) == 0
    line = triangle_rows(np.array([[[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]]))
    assert solid_angles(line, np.array([[0.5], [0.1], [0.2]])) == 0


def test_slivers_are_never_nearer_than_they_are() -> None:
    rng = np.random.default_rng(0)
    start = soup(200)[:, 0]
    way = rng.normal(0, 0.3, (200, 3))
    sliver = np.stack([start, start + way, start + 0.5 * way + rng.normal(0, 1e-13, (200, 3))], 1)
    points = points_about(sliver, 200)
    rows, columns = triangle_rows(sliver), points.T
    squared = squared_distances(rows, columns)
    along = np.clip(((points - start) * way).sum(1) / (way**2).sum(1), 0, 1)
    to_line = np.linalg.norm(points - start - along[:, None] * way, axis=1)
    np.testing.assert_allclose(np.sqrt(squared), to_line, atol=1e-11)
