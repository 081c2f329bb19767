from __future__ import annotations

import igl
import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.infer.mesh_search import SearchConfig
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import multipoles
from nispcodec.infer.winding_number import winding_numbers
from tests.infer.parts import cube, points_off, soup, sphere

CONFIG = SearchConfig()
MESHES = {
    "cube": cube(),
    "sphere": sphere(20),
    "half a sphere": sphere(20)[:400],
    "cubes that overlap": np.concatenate([cube(), cube(0.7, (0.3, 0.2, 0.1))]),
    "soup": soup(500),
}


def exact(corners: Float64Array, points: Float64Array) -> Float64Array:
    vertices = np.ascontiguousarray(corners.reshape(-1, 3))
    triangles = np.arange(len(vertices), dtype=np.int64).reshape(-1, 3)
    return np.asarray(igl.winding_number(vertices, triangles, points))


@pytest.mark.parametrize("name", MESHES)
def test_it_is_that_of_libigl_nearly(name: str) -> None:
    corners = MESHES[name]
    points = points_off(corners, 300)
    tree = MeshTree.of(corners, np.zeros(len(corners), np.bool_))
    clusters, expected = multipoles(tree), exact(corners, points)
    rough = winding_numbers(tree, clusters, points, CONFIG.rough)
    assert np.abs(rough - expected).max() < CONFIG.margin / 2
    fine = winding_numbers(tree, clusters, points, CONFIG.exact)
    assert np.abs(fine - expected).max() < 5e-3
    every = winding_numbers(tree, clusters, points, 1e9)
    np.testing.assert_allclose(every, expected, atol=1e-9)


def test_sheets_do_not_count() -> None:
    body, sheet = cube(), soup(100)
    corners = np.concatenate([sheet, body])
    points = points_off(corners, 300)
    tree = MeshTree.of(corners, np.arange(112) < 100)
    numbers = winding_numbers(tree, multipoles(tree), points, CONFIG.exact)
    np.testing.assert_allclose(numbers, exact(body, points), atol=5e-3)
