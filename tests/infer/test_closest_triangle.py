from __future__ import annotations

import igl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.arrays import Float64Array
from nispcodec.infer.closest_triangle import closest_triangles
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.triangles import squared_distances, triangle_rows
from tests.infer.parts import cube, points_about, soup, sphere


def tree_of(corners: Float64Array) -> MeshTree:
    return MeshTree.of(corners, np.zeros(len(corners), np.bool_))


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 200), st.integers(0, 2**16), st.sampled_from([0.0, 0.25]))
def test_it_is_the_first_of_the_nearest_of_all(count: int, seed: int, grid: float) -> None:
    corners = soup(count, seed)
    if grid:  # Many corners and edges in common, many triangles without area.
        corners = np.rint(corners / grid) * grid
    points = points_about(corners, 60, seed)
    faces, squared = closest_triangles(tree_of(corners), points)
    every = squared_distances(triangle_rows(corners)[:, :, None], points.T[:, None])
    np.testing.assert_array_equal(squared, every.min(axis=0))
    np.testing.assert_array_equal(faces, every.argmin(axis=0))


@pytest.mark.parametrize("corners", [cube(), sphere(20), soup(300)], ids=["cube", "sphere", "soup"])
def test_distances_are_those_of_libigl(corners: Float64Array) -> None:
    points = points_about(corners, 2000)
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
    expected, _, _ = igl.point_mesh_squared_distance(points, vertices, triangles)
    _, squared = closest_triangles(tree_of(corners), points)
    np.testing.assert_allclose(np.sqrt(squared), np.sqrt(expected), atol=1e-12)


def test_at_a_corner_of_all_it_is_the_first() -> None:
    """From any of the triangles about a corner the distance is the same to the last bit."""
    corners = sphere(8)
    points = 1.7 * corners.reshape(-1, 3)
    points += np.random.default_rng(0).normal(0, 1e-3, points.shape)
    for order in (np.arange(len(corners)), np.arange(len(corners))[::-1]):
        faces, _ = closest_triangles(tree_of(corners[order]), points)
        every = squared_distances(triangle_rows(corners[order])[:, :, None], points.T[:, None])
        np.testing.assert_array_equal(faces, every.argmin(axis=0))
