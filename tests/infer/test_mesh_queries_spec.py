"""The specification's own Python for mesh parts says what the library says."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.mesh_part import Placement
from nispcodec.core.placing import placed_points
from nispcodec.infer.mesh_queries import PlacedMeshes
from tests.format import spec
from tests.infer.parts import cube, part_of, points_off, soup

DECODER = spec.decoder()
MESHES = {
    "cubes that overlap": np.concatenate([cube(), cube(0.7, (0.3, 0.2, 0.1))]),
    "a sheet beside a cube": np.concatenate([cube(0.4), soup(10)]),
    "without area": np.concatenate([cube(), np.repeat(cube()[:, :1], 3, axis=1)]),
}


@pytest.mark.parametrize("name", MESHES)
def test_distances_and_closest_triangles(name: str) -> None:
    corners = MESHES[name]
    sheet = (np.arange(len(corners)) >= 12) & ("sheet" in name)
    meshes = PlacedMeshes((part_of(corners, sheet),))
    points = points_off(corners, 100)
    sdf, found = meshes.sdf(points), meshes.closest(points)
    for row, point in enumerate(points.tolist()):
        triangles = meshes.triangles.corners
        asked = triangles.tolist(), sheet.tolist(), point
        distance, number, weights = DECODER["ask_triangles"](*asked)
        assert sdf[row] == pytest.approx(distance, abs=1e-6)
        on_it = np.asarray(weights) @ triangles[number]
        np.testing.assert_allclose(on_it, found.point[row], atol=1e-9)


def test_where_a_copy_is() -> None:
    rng = np.random.default_rng(0)
    turn: Float64Array = rng.normal(size=4)
    turn /= np.linalg.norm(turn)
    plain = Placement(tuple(turn.tolist()), (0.1, 0.2, -0.3), 0.7)
    points = rng.normal(size=(5, 3))
    for placement in (plain, replace(plain, mirrored=True)):
        expected = [DECODER["placed"](asdict(placement), point) for point in points.tolist()]
        np.testing.assert_allclose(placed_points(placement, points), expected)
