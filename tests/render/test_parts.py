from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.document import Document
from nispcodec.model import NispModel
from nispcodec.render.camera import Camera, turntable
from nispcodec.render.channels import channel_picture
from nispcodec.render.maps import Maps
from nispcodec.render.parts import model_scene
from nispcodec.render.picture import Eye
from nispcodec.render.views import on_white, render_views
from tests import tiny
from tests.infer.parts import cube, part_of

MESH = part_of(cube(0.4, (0.6, 0.6, 0.0)), charts=2)


@pytest.fixture(scope="module")
def both() -> Document:
    return replace(tiny.document(), meshes=(MESH,))


@pytest.mark.parametrize("kind", ["both", "mesh"])
def test_a_model_looks_like_the_mesh_that_it_decodes_to(both: Document, kind: str) -> None:
    model = NispModel(both if kind == "both" else replace(both, field=None))
    views = turntable(3)
    ours = render_views(model, views, 64)
    theirs = render_views(model.to_mesh(96), views, 64, both.frame)
    for first, second in zip(theirs, ours, strict=True):
        assert np.abs(on_white(first) - on_white(second)).mean() < 0.01
        assert np.abs(first[..., 3] - second[..., 3]).mean() < 3e-3


def test_both_parts_are_seen_with_their_charts(both: Document) -> None:
    scene = model_scene(both)
    eye = Eye(scene, Maps(scene.textures), Camera(40, 20), 48)
    assert set(eye.pixels().charts[np.isfinite(eye.pixels().distances)]) == {0, 1, 2, 3}
    assert channel_picture(eye, "chart").shape == (48, 48, 4)


def test_a_field_is_seen_through_a_mesh_of_glass(both: Document) -> None:
    """Behind the glass the ray is outside of the field, though it has crossed a surface."""
    glass = Material("glass", base_color=(1.0, 1.0, 1.0, 0.5), alpha_mode="blend")
    solid = replace(both.materials[1], base_color=(1.0, 0.0, 0.0, 1.0), maps={})
    pane = replace(part_of(cube(1.9)), chart_materials=np.ones(1, np.int32))
    table = replace(both.field.charts, materials=np.zeros(2, np.int32))  # type: ignore[union-attr]
    through = tiny.varied(both, charts=table, meshes=(pane,), materials=(solid, glass), textures=())
    (picture,) = render_views(NispModel(through), [Camera(10, 10)], 33)
    (plain,) = render_views(NispModel(replace(through, meshes=())), [Camera(10, 10)], 33)
    assert plain[16, 16, 3] == picture[16, 16, 3] == 1
    assert picture[16, 16, 0] > picture[16, 16, 1] + 0.1
    assert picture[2, 16, 3] == pytest.approx(0.75, abs=0.02)
