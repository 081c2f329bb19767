from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.core.progress import Progress
from nispcodec.metrics.surface import frame_of
from nispcodec.model import NispModel
from nispcodec.render.camera import turntable
from nispcodec.render.difference import close_ups
from nispcodec.render.layout import layouts
from nispcodec.render.sheet import CLOSE_UPS, LINE, VIEWS, sheet
from nispcodec.render.views import scene_of
from tests import tiny
from tests.metrics.shapes import sphere

BALL = sphere(subdivisions=2)


def bare(mesh: TexturedMesh) -> TexturedMesh:
    return dataclasses.replace(mesh, uv_faces=np.full_like(mesh.uv_faces, -1))


def test_equal_meshes_have_no_difference() -> None:
    found = sheet(BALL, BALL, 48)
    assert found.picture.shape == (2 * LINE + 3 * 48, (VIEWS + CLOSE_UPS + 1) * 48, 3)
    # Below the text of the last row.
    assert (found.picture[-20:] == 1).all()
    assert found.report["pictures"] == {"psnr": 200.0, "ssim": pytest.approx(1.0)}


def test_a_model_beside_its_own_mesh(monkeypatch: pytest.MonkeyPatch) -> None:
    model = NispModel(tiny.document(tiny.octahedron(1.0), frame=Frame((0.0, 0.0, 0.0), 1.0)))
    mesh = model.to_mesh(64)
    heard: list[Progress] = []
    monkeypatch.setattr(model, "to_mesh", lambda: mesh)
    found = sheet(mesh, model, 48, "title", heard.append)
    assert [each.stage for each in heard] == ["views", "close-ups", "UV layouts", "numbers"]
    psnr = found.report["pictures"]["psnr"]
    assert isinstance(psnr, float)
    assert psnr > 25
    assert "charts" in found.report


def test_without_uvs_there_is_no_layout() -> None:
    assert sheet(bare(BALL), BALL, 32).picture.shape[1] == (VIEWS + CLOSE_UPS) * 32


def test_layouts_show_what_is_misplaced() -> None:
    wrong = dataclasses.replace(BALL, uvs=BALL.uvs * 0.5)
    first, same, nothing = layouts(BALL, BALL, frame_of(BALL), 32)
    _, other, off = layouts(BALL, wrong, frame_of(BALL), 32)
    np.testing.assert_array_equal(first, same)
    assert nothing.max() < 1e-5
    assert off.max() > 0.3
    assert not np.array_equal(first, other)


def test_close_ups_look_at_the_largest_difference() -> None:
    views = turntable(3)
    differences = [np.zeros((64, 64), np.float32) for _ in views]
    differences[2][20:24, 40:44] = 1
    (found,) = close_ups(scene_of(BALL), views, differences, 1)
    assert (found.azimuth, found.zoom) == (views[2].azimuth, 6.0)
    assert np.linalg.norm(found.target) == pytest.approx(1, abs=0.02)
    towards = np.asarray(found.target) - views[2].eye
    wanted = views[2].directions(np.array([42 / 64]), np.array([22 / 64]))[0]
    np.testing.assert_allclose(towards / np.linalg.norm(towards), wanted, atol=0.02)


def test_close_ups_do_not_look_at_one_place_twice() -> None:
    views = turntable(2)
    differences = [np.zeros((64, 64), np.float32) for _ in views]
    # The top of the ball in both views; less of a difference at its foot.
    for view, each in zip(views, differences, strict=True):
        (across, down) = (64 * view.places(np.array([[0, 0.9, 0]]))[0]).astype(int)
        each[down - 2 : down + 2, across - 2 : across + 2] = 1
    differences[0][50:54, 30:34] = 0.5
    first, second = close_ups(scene_of(BALL), views, differences, 2)
    assert first.target[1] > 0.8
    assert second.target[1] < 0
