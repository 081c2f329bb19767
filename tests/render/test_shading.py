from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.render.camera import Camera
from nispcodec.render.maps import Maps
from nispcodec.render.picture import Eye
from nispcodec.render.raycast import MeshScene
from nispcodec.render.views import render_views
from tests.metrics.shapes import plane
from tests.render.scenes import UNIT, square, with_maps

FRONT = Camera(0, 0)
FLAT, RIGHT, UP = (128, 128, 255), (218, 128, 218), (128, 218, 218)
"""Normals straight up, and leaning by 45 degrees to where u grows and to where v grows."""


def normal_at_middle(
    mesh: TexturedMesh, camera: Camera = FRONT, normal_map: bool = True
) -> np.ndarray:
    scene = MeshScene(mesh, UNIT)
    eye = Eye(scene, Maps(scene.textures), camera, 17, normal_map)
    return eye.pixels().normals.reshape(17, 17, 3)[8, 8]


@pytest.mark.parametrize(("texel", "axis"), [(RIGHT, 0), (UP, 1)])
def test_normal_maps_lean_to_where_u_and_v_grow(texel: object, axis: int) -> None:
    found = normal_at_middle(square(normal=[[texel]]))
    expected = np.array([0, 0, np.sqrt(0.5)])
    expected[axis] = np.sqrt(0.5)
    np.testing.assert_allclose(found, expected, atol=0.02)


@pytest.mark.parametrize(("texel", "expected"), [(RIGHT, (-1, 0)), (UP, (0, 1))])
def test_normal_maps_of_mirrored_charts(texel: object, expected: tuple[int, int]) -> None:
    """u grows to the left here: what leans to u leans left."""
    mesh = square(normal=[[texel]])
    mesh = dataclasses.replace(mesh, uvs=mesh.uvs * [-1, 1] + [1, 0])
    found = normal_at_middle(mesh)
    np.testing.assert_allclose(found[:2], np.sqrt(0.5) * np.array(expected), atol=0.02)


def test_normal_maps_look_alike_whatever_the_winding() -> None:
    mesh = square(normal=[[RIGHT]])
    turned = dataclasses.replace(
        mesh, faces=mesh.faces[:, ::-1].copy(), uv_faces=mesh.uv_faces[:, ::-1].copy()
    )
    np.testing.assert_allclose(normal_at_middle(turned), normal_at_middle(mesh), atol=1e-5)


def test_normal_maps_can_be_left_out() -> None:
    found = normal_at_middle(square(normal=[[RIGHT]]), normal_map=False)
    np.testing.assert_allclose(found, (0, 0, 1), atol=1e-6)


def test_surfaces_towards_the_lamp_are_brighter() -> None:
    """The lamp stands to the left of the camera and above it."""
    left, flat, right = (
        render_views(square(normal=[[texel]]), [FRONT], 16, UNIT)[0][8, 8, 0]
        for texel in ((38, 128, 218), FLAT, RIGHT)
    )
    assert left > right
    assert flat > right


def test_color_factors_are_linear_and_textures_are_srgb() -> None:
    white = render_views(square(base_color=[[(255, 255, 255)]]), [FRONT], 16, UNIT)[0]
    gray = render_views(square(base_color=[[(188, 188, 188)]]), [FRONT], 16, UNIT)[0]
    mesh = dataclasses.replace(plane(), materials=(Material(base_color=(0.5, 0.5, 0.5, 1.0)),))
    half = render_views(mesh, [FRONT], 16, UNIT)[0]
    np.testing.assert_allclose(gray[8, 8], half[8, 8], atol=4e-3)
    assert half[8, 8, 0] < white[8, 8, 0]


def test_emission_needs_no_light() -> None:
    black = Material(base_color=(0.0, 0.0, 0.0, 1.0), emissive=(0.0, 1.0, 0.0))
    (picture,) = render_views(dataclasses.replace(plane(), materials=(black,)), [FRONT], 16, UNIT)
    assert picture[8, 8, 1] == pytest.approx(1)
    assert picture[8, 8, 0] < 0.3


def test_fine_patterns_become_their_mean_and_not_noise() -> None:
    checks = np.indices((512, 512)).sum(axis=0)[..., None].repeat(3, axis=2) % 2 * 255
    fine, even = (
        render_views(with_maps(plane(), "linear", base_color=pixels), [Camera(20, 20)], 48, UNIT)
        for pixels in (checks, [[(188, 188, 188)]])
    )
    inside = even[0][..., 3] == 1
    np.testing.assert_allclose(fine[0][inside], even[0][inside], atol=0.02)
