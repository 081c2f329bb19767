"""The kernel gives what numpy gives: distances to the last bit, winding numbers nearly."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.infer.closest_triangle import closest_triangles
from nispcodec.infer.mesh_search import SearchConfig
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import multipoles
from nispcodec.infer.native.mesh_kernel import MeshKernel
from nispcodec.infer.numpy_mesh import NumpyMesh
from nispcodec.infer.winding_number import winding_numbers
from tests.infer.parts import cube, points_about, points_off, soup, sphere

CONFIG = SearchConfig()
MESHES = {
    "one triangle": soup(1),
    "eight triangles": soup(8),
    "nine triangles": soup(9),
    "soup": soup(700),
    "cube": cube(),
    "sphere": sphere(24),
    "cubes that overlap": np.concatenate([cube(), cube(0.7, (0.3, 0.2, 0.1))]),
    "without area": np.concatenate([cube(), np.repeat(cube()[:, :1], 3, axis=1)]),
}


def some_sheet(corners: Float64Array) -> BoolArray:
    return np.arange(len(corners)) % 5 == 4


@pytest.mark.parametrize("name", MESHES)
def test_closest_triangles_are_the_same(name: str, isa: str) -> None:
    corners = MESHES[name]
    points = points_about(corners, 1000)
    tree = MeshTree.of(corners, some_sheet(corners))
    faces, squared = MeshKernel(tree, multipoles(tree), isa).closest(points)
    expected_faces, expected = closest_triangles(tree, points)
    np.testing.assert_array_equal(squared, expected)
    np.testing.assert_array_equal(faces, expected_faces)


@pytest.mark.parametrize("name", MESHES)
def test_winding_numbers_are_the_same(name: str, isa: str) -> None:
    corners = MESHES[name]
    points = points_off(corners, 1000)
    tree = MeshTree.of(corners, some_sheet(corners))
    clusters = multipoles(tree)
    for radii in (CONFIG.rough, CONFIG.exact):
        numbers = MeshKernel(tree, clusters, isa).winding(points, radii)
        expected = winding_numbers(tree, clusters, points, radii)
        np.testing.assert_allclose(numbers, expected, atol=2e-4)


@pytest.mark.parametrize("name", MESHES)
def test_the_same_points_are_inside(name: str, isa: str) -> None:
    corners = MESHES[name]
    points = points_off(corners, 1000)
    tree = MeshTree.of(corners, some_sheet(corners))
    clusters = multipoles(tree)
    asked = (points, CONFIG.rough, CONFIG.margin, CONFIG.exact)
    inside = MeshKernel(tree, clusters, isa).inside(*asked)
    number = np.abs(winding_numbers(tree, clusters, points, CONFIG.exact))
    clear = np.abs(number - 0.5) > 1e-3
    np.testing.assert_array_equal(inside[clear], NumpyMesh(tree, clusters).inside(*asked)[clear])


def test_no_points_are_no_answers(isa: str) -> None:
    tree = MeshTree.of(cube(), np.zeros(12, np.bool_))
    kernel = MeshKernel(tree, multipoles(tree), isa)
    none = np.zeros((0, 3))
    assert kernel.closest(none)[0].shape == (0,)
    assert kernel.inside(none, 2.0, 0.1, 6.0).shape == (0,)


def test_points_a_million_radii_away_are_answered(isa: str) -> None:
    tree = MeshTree.of(cube(), np.zeros(12, np.bool_))
    kernel = MeshKernel(tree, multipoles(tree), isa)
    points = np.array([[1e6, 1e6, -1e6], [0, 1e6, 0]])
    _, squared = kernel.closest(points)
    np.testing.assert_allclose(np.sqrt(squared), [(1e6 - 0.5) * 3**0.5, 1e6 - 0.5])
    np.testing.assert_allclose(kernel.winding(points, 2.0), 0, atol=1e-9)
