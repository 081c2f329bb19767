from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable
from nispcodec.core.errors import QueryError
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera, turntable
from nispcodec.render.channels import CHANNELS, channel_picture
from nispcodec.render.field import FieldScene
from nispcodec.render.maps import Maps
from nispcodec.render.picture import Eye
from nispcodec.render.views import on_white, render_views
from tests import tiny
from tests.tiny import field_of, varied


@pytest.fixture(scope="module")
def model() -> NispModel:
    return NispModel(tiny.document())


@pytest.fixture(scope="module")
def scene(model: NispModel) -> FieldScene:
    return FieldScene(model.document, field_of(model.document))


def eye(scene: FieldScene, size: int = 48) -> Eye:
    return Eye(scene, Maps(scene.textures), Camera(), size)


def test_a_model_looks_like_the_mesh_that_it_decodes_to(model: NispModel) -> None:
    views = turntable(2)
    ours = render_views(model, views, 64)
    theirs = render_views(model.to_mesh(96), views, 64, model.document.frame)
    for first, second in zip(theirs, ours, strict=True):
        assert compare_pictures(on_white(first), on_white(second))["psnr"] > 30
        assert np.abs(first[..., 3] - second[..., 3]).mean() < 2e-3


def test_jacobians_lie_in_the_surface_and_say_how_uv_changes(scene: FieldScene) -> None:
    camera = Camera(30, 20)
    directions = camera.directions(np.array([0.4, 0.6]), np.array([0.5, 0.45]))
    origins = np.tile(camera.eye.astype(np.float32), (2, 1))
    found = scene.cast(origins, directions).fragments
    np.testing.assert_allclose(
        np.einsum("nkd,nd->nk", found.jacobians, found.normals), 0, atol=1e-3
    )
    # The tiny UV is (y, z) / 4: its gradient, less what points out of the surface.
    gradients = np.array([[0, 0.25, 0], [0, 0, 0.25]])
    along = gradients @ found.normals.T
    expected = gradients[None] - along.T[..., None] * found.normals[:, None]
    np.testing.assert_allclose(found.jacobians, expected, atol=2e-3)


def test_openings_are_not_seen(model: NispModel) -> None:
    table = field_of(model.document).charts
    charts = dataclasses.replace(table, has_uv=np.array([True, False]), openings=True)
    opened = NispModel(tiny.varied(model.document, charts=charts))
    (whole,), (half,) = (render_views(each, [Camera(80, 10)], 32) for each in (model, opened))
    # Through the opening, the inside of the other half.
    assert whole[13, 19, 3] == half[13, 19, 3] == 1
    assert not np.allclose(whole[13, 19], half[13, 19])


def test_glass_shows_front_and_back(model: NispModel) -> None:
    glass = Material(base_color=(1.0, 1.0, 1.0, 0.5), alpha_mode="blend")
    clear = dataclasses.replace(model.document, materials=(glass, glass), textures=())
    (picture,) = render_views(NispModel(clear), [Camera(30, 20)], 33)
    assert picture[19, 13, 3] == pytest.approx(0.75, abs=1e-3)


@pytest.mark.parametrize("channel", CHANNELS)
def test_every_channel_is_a_picture(scene: FieldScene, channel: str) -> None:
    picture = channel_picture(eye(scene), channel)
    assert picture.shape == (48, 48, 4)
    assert picture.dtype == np.float32
    assert picture.min() >= 0
    assert picture.max() <= 1
    assert np.ptp(picture[..., :3]) > 0.1
    assert (picture[0, 0, 3] == 0) == (channel != "sdf-steps")


def test_unknown_channel_is_refused(scene: FieldScene) -> None:
    with pytest.raises(QueryError, match="channel: expected one of color, normal"):
        channel_picture(eye(scene), "smell")


def test_normal_channel_shows_world_axes(scene: FieldScene) -> None:
    seen = Eye(scene, Maps(scene.textures), Camera(10, 0), 33)
    picture = channel_picture(seen, "normal")[13, 18, :3]
    np.testing.assert_allclose(np.abs(picture * 2 - 1), 1 / np.sqrt(3), atol=0.02)
    assert picture[2] > 0.5


def test_geometry_alone_can_be_seen() -> None:
    bare = varied(
        tiny.document(),
        charts=ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_)),
        chart=None,
        uv=None,
    )
    (picture,) = render_views(NispModel(bare), [Camera()], 24)
    assert picture[11, 12, 3] == 1


def test_a_field_without_a_surface_is_an_empty_picture() -> None:
    nothing = varied(tiny.document(), sdf=tiny.octahedron(-1.0))
    (picture,) = render_views(NispModel(nothing), [Camera()], 24)
    assert (picture == 0).all()
