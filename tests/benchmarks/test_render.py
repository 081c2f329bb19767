from __future__ import annotations

import dataclasses
import io

import numpy as np
import PIL.Image
import pytest

from nispcodec.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.document import Frame
from nispcodec.metrics.surface import frame_of
from tests.metrics.shapes import plane, sphere

pytest.importorskip("embreex", reason="pictures need the extra `bench`")

from benchmarks.render import Camera, Scene, turntable
from benchmarks.sheet import sheet

FRONT = Camera((0.0, 0.0, 5.0))
UNIT = Frame((0.5, 0.5, 0.0), 1.0)


def painted(mesh: TexturedMesh, pixels: list[list[tuple[int, int, int]]]) -> TexturedMesh:
    buffer = io.BytesIO()
    PIL.Image.fromarray(np.array(pixels, dtype=np.uint8)).save(buffer, "PNG")
    used = TextureMap(0, ("clamp", "clamp"), "nearest")
    return dataclasses.replace(
        mesh,
        materials=(Material(maps={"base_color": used}),),
        textures=(Texture("t.png", buffer.getvalue(), "image/png"),),
    )


def test_picture_has_the_texture_the_right_way_round() -> None:
    red, green, blue, black = (255, 0, 0), (0, 255, 0), (0, 0, 255), (0, 0, 0)
    mesh = painted(plane(), [[red, green], [blue, black]])
    picture = Scene(mesh, UNIT).render(FRONT, 64)
    quarters = [picture[28, 28], picture[28, 36], picture[36, 28], picture[36, 36]]
    names = [int(np.argmax(color)) if color.max() > 0.1 else -1 for color in quarters]
    assert names == [0, 1, 2, -1]


def test_background_is_white() -> None:
    picture = Scene(plane(), UNIT).render(FRONT, 32)
    np.testing.assert_array_equal(picture[0, 0], 1)


def test_silhouette_of_a_sphere() -> None:
    ball = sphere()
    picture = Scene(painted(ball, [[(0, 0, 0)]]), frame_of(ball)).render(Camera((0, 0, 5)), 200)
    covered = (picture.mean(axis=2) < 0.5).mean()
    reach, seen = np.tan(np.radians(16)), np.tan(np.arcsin(1 / 5))
    assert covered == pytest.approx(np.pi * (seen / reach) ** 2 / 4, rel=0.02)


def test_nearer_surface_hides_the_farther() -> None:
    near, far = plane(0.2), plane(-0.2)
    eye = Scene(near, UNIT)
    rows, points = eye.hits(np.asarray(FRONT.eye), FRONT.rays(16))
    assert len(rows) > 0
    np.testing.assert_allclose(points.positions[:, 2], 0.2, atol=1e-6)
    _, behind = Scene(far, UNIT).hits(np.asarray(FRONT.eye), FRONT.rays(16))
    np.testing.assert_allclose(behind.positions[:, 2], -0.2, atol=1e-6)


def test_turntable_sees_the_whole_unit_ball() -> None:
    for camera in turntable():
        distance = float(np.linalg.norm(camera.eye))
        assert np.degrees(np.arcsin(1 / distance)) <= camera.angle / 2


def test_sheet_of_equal_meshes_has_no_difference() -> None:
    picture = np.asarray(sheet(sphere(subdivisions=2), sphere(subdivisions=2), 64))
    differences = picture[-40:]
    assert picture.shape[1] == 5 * 64
    assert (differences == 255).all()
