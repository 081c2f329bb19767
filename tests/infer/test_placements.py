from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MAX_PLACED_FACES, Placement
from nispcodec.core.placing import placed_points, rotation_matrix
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.infer.placements import PlacedTriangles
from nispcodec.infer.surface_normals import SurfaceNormals
from tests.infer.parts import part_of, points_about, soup, sphere

HALF = 0.5**0.5
PLACEMENTS = {
    "moved": Placement(offset=(0.1, -0.2, 0.3)),
    "turned about z": Placement(rotation=(HALF, 0, 0, HALF)),
    "scaled": Placement(scale=0.5),
    "mirrored": Placement(mirrored=True),
    "all": Placement((0.5, 0.5, -0.5, 0.5), (0.1, 0.1, -0.1), 0.7, mirrored=True),
}


def test_rotations_are_what_a_quaternion_means() -> None:
    np.testing.assert_allclose(rotation_matrix((1, 0, 0, 0)), np.eye(3))
    quarter = rotation_matrix((HALF, 0, 0, HALF))
    np.testing.assert_allclose(quarter @ [1, 0, 0], [0, 1, 0], atol=1e-12)
    quaternion = np.random.default_rng(0).normal(size=4)
    any_turn = rotation_matrix(tuple(quaternion.tolist()))
    np.testing.assert_allclose(any_turn @ any_turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(any_turn) == pytest.approx(1)


def test_a_point_is_mirrored_then_turned_then_scaled_then_moved() -> None:
    placement = Placement((HALF, 0, 0, HALF), (10, 20, 30), 2.0, mirrored=True)
    np.testing.assert_allclose(placed_points(placement, np.array([[1.0, 2, 3]])), [[6, 18, 36]])


@pytest.mark.parametrize("name", PLACEMENTS)
def test_a_copy_answers_as_the_part_does_elsewhere(name: str) -> None:
    """The distance where a point goes to is the distance where it was, times the scale."""
    placement = PLACEMENTS[name]
    part = part_of(sphere(12) * [1, 0.6, 0.8] + [0.1, 0, 0])
    points = points_about(sphere(12), 500)
    there = PlacedMeshes((replace(part, placements=(placement,)),))
    here = PlacedMeshes((part,))
    moved = placed_points(placement, points)
    np.testing.assert_allclose(
        there.sdf(moved), placement.scale * here.sdf(points), rtol=1e-6, atol=1e-7
    )
    clear = np.abs(here.sdf(points)) > 1e-3
    turned = replace(placement, offset=(0, 0, 0), scale=1.0)
    expected = placed_points(turned, here.normals(points).astype(np.float64))
    np.testing.assert_allclose(there.normals(moved)[clear], expected[clear], atol=1e-4)
    np.testing.assert_allclose(there.uv(moved)[clear], here.uv(points)[clear], atol=1e-5)


def test_faces_of_a_mirrored_copy_look_outwards() -> None:
    copies = (Placement(), Placement(mirrored=True, offset=(0.3, 0, 0)))
    placed = PlacedMeshes((replace(part_of(sphere(10)), placements=copies),))
    both = np.array([[0.15, 0.0, 0.0]])
    assert placed.sdf(both)[0] < 0
    centers = placed.triangles.corners.mean(axis=1)
    middles = np.repeat([[0.0, 0, 0], [0.3, 0, 0]], len(centers) // 2, axis=0)
    normals = SurfaceNormals(placed.triangles.corners).faces
    assert ((normals * (centers - middles)).sum(axis=1) > -1e-9).all()


def test_what_belongs_to_a_corner_goes_where_the_corner_goes() -> None:
    def pairs(mirrored: bool) -> Float64Array:
        copies = (Placement(mirrored=mirrored),)
        placed = PlacedTriangles.of((replace(part_of(soup(5)), placements=copies),))
        return np.concatenate([placed.corners, placed.uvs], axis=2)

    plain, mirrored = pairs(False), pairs(True)
    plain[:, :, 0] *= -1
    np.testing.assert_allclose(mirrored, plain[:, [0, 2, 1]])


def test_more_copies_than_can_be_held_are_refused() -> None:
    count = MAX_PLACED_FACES // 5 + 1
    part = replace(part_of(soup(5)), placements=(Placement(),) * count)
    with pytest.raises(FormatError, match=f"field placed_faces: expected at most {2**21}"):
        PlacedTriangles.of((part,))


def test_copies_out_of_the_world_are_refused() -> None:
    part = replace(part_of(soup(5)), placements=(Placement(offset=(0, 1e7, 0)),))
    with pytest.raises(FormatError, match="coordinates up to"):
        PlacedTriangles.of((part,))
