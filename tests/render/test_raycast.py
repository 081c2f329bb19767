from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.metrics.surface import Surface, frame_of
from nispcodec.render.camera import Camera
from nispcodec.render.normals import corner_normals
from nispcodec.render.raycast import MeshScene
from nispcodec.render.views import on_white, render_views
from tests.metrics.shapes import joined, plane, sphere
from tests.render.scenes import UNIT, square, with_maps

FRONT = Camera(0, 0)
RED, GREEN, BLUE, BLACK = (255, 0, 0), (0, 255, 0), (0, 0, 255), (0, 0, 0)


def test_the_texture_is_the_right_way_round() -> None:
    mesh = square(base_color=[[RED, GREEN], [BLUE, BLACK]])
    (picture,) = render_views(mesh, [FRONT], 64, UNIT)
    quarters = [picture[y, x, :3] for y, x in ((24, 24), (24, 40), (40, 24), (40, 40))]
    assert [int(np.argmax(c)) if c.max() > 0.2 else -1 for c in quarters] == [0, 1, 2, -1]


def test_the_ground_is_transparent_and_white_below() -> None:
    (picture,) = render_views(plane(), [FRONT], 32, UNIT)
    assert picture.shape == (32, 32, 4)
    assert picture[0, 0, 3] == 0
    assert picture[16, 16, 3] == 1
    np.testing.assert_array_equal(on_white(picture)[0, 0], 1)


def test_silhouette_of_a_sphere() -> None:
    ball = sphere()
    (picture,) = render_views(ball, [FRONT], 100)
    seen = np.tan(np.arcsin(1 / np.linalg.norm(FRONT.eye))) / FRONT.half_width
    assert picture[..., 3].mean() == pytest.approx(np.pi * seen**2 / 4, rel=0.01)


def test_the_nearer_surface_hides_the_farther() -> None:
    scene = MeshScene(joined(plane(-0.2), plane(0.2)), UNIT)
    origins = np.tile(FRONT.eye.astype(np.float32), (1, 1))
    found = scene.cast(origins, np.array([[0, 0, -1]], np.float32)).fragments
    assert FRONT.eye[2] - found.distances[0] == pytest.approx(0.2, abs=1e-5)


@pytest.mark.parametrize(("camera", "seen"), [(FRONT, 0), (Camera(180, 0), 1)])
def test_of_two_faces_back_to_back_the_one_in_front_is_seen(camera: Camera, seen: int) -> None:
    front = plane()
    both = joined(front, dataclasses.replace(front, faces=front.faces[:, ::-1].copy()))
    materials = np.repeat(np.array([0, 1], np.int32), len(front.faces))
    colored = tuple(Material(base_color=color) for color in ((1.0, 0.0, 0, 1), (0.0, 1.0, 0, 1)))
    mesh = dataclasses.replace(both, materials=colored, face_materials=materials)
    (picture,) = render_views(mesh, [camera], 64, UNIT)
    assert (picture[20:44, 20:44, :3].argmax(axis=2) == seen).all()


def test_cut_outs_show_what_is_behind() -> None:
    half = [[(255, 0, 0, 255), (255, 0, 0, 100)]]
    mesh = with_maps(joined(plane(0.2), plane(-0.2)), base_color=half)
    behind = len(plane().faces)
    cut = dataclasses.replace(mesh.materials[0], alpha_mode="mask")
    green = Material(base_color=(0.0, 1.0, 0.0, 1.0))
    materials = np.repeat(np.array([0, 1], np.int32), behind)
    mesh = dataclasses.replace(mesh, materials=(cut, green), face_materials=materials)
    (picture,) = render_views(mesh, [FRONT], 64, UNIT)
    assert picture[32, 24, :3].argmax() == 0
    assert picture[32, 40, 1] > 0.5 > picture[32, 40, 0]
    assert (picture[20:44, 20:44, 3] == 1).all()


def test_blended_surfaces_let_a_share_through() -> None:
    mesh = square(base_color=[[(255, 0, 0, 128)]])
    glass = dataclasses.replace(mesh.materials[0], alpha_mode="blend")
    (picture,) = render_views(dataclasses.replace(mesh, materials=(glass,)), [FRONT], 32, UNIT)
    assert picture[16, 16, 3] == pytest.approx(128 / 255, abs=1e-3)


def test_corner_normals_are_smooth_on_a_sphere_and_hard_on_a_crease() -> None:
    ball = sphere(subdivisions=3)
    surface = Surface.of(ball, frame_of(ball))
    normals = corner_normals(surface)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    np.testing.assert_allclose(normals, surface.corners, atol=0.02)
    wall = plane()
    turned = dataclasses.replace(wall, positions=wall.positions[:, [2, 1, 0]])
    both = joined(wall, turned)
    edge = Surface(both, both.positions)
    normals = corner_normals(edge)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    np.testing.assert_allclose(normals, np.repeat(edge.normals[:, None], 3, axis=1), atol=1e-6)
