"""Detail: samples are drawn again where the texture changes, and only there."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.dataset import recipes as training
from nispcodec.dataset.sampler import Sampler
from nispcodec.dataset.texture_gradient import NEARBY, detail
from tests.geometry.shapes import box_asset

EDGE = 1 / 6
"""u of the edge between black and white: through the middle of the chart of the first side."""


def printed(*, mapped: tuple[int, ...] = (0,)) -> TexturedMesh:
    """The box, with an image that is black left of `EDGE` and white right of it, on materials."""
    pixels = np.zeros((8, 6000, 3), np.uint8)
    pixels[:, 1000:] = 255
    file = BytesIO()
    PIL.Image.fromarray(pixels).save(file, "PNG")
    box, maps = box_asset(), {"base_color": TextureMap(0, wrap=("clamp", "clamp"))}
    materials = tuple(Material(str(i), maps=maps if i in mapped else {}) for i in range(2))
    textures = (Texture("edge.png", file.getvalue(), "image/png"),)
    return replace(box, materials=materials, textures=textures)


def test_change_is_found_at_the_edge_alone() -> None:
    mesh = printed()
    sampler = Sampler(mesh, 0)
    samples = sampler.surface(50_000)
    uvs = samples.uv * sampler.table.uv_scale + sampler.table.uv_offset
    off = np.abs(uvs[:, 0] - EDGE)
    owned = sampler.table.materials[samples.chart] == 0
    found = detail(mesh, sampler.table, samples)
    near, texel = owned & (off < 0.5 * NEARBY), 1 / 6000
    assert near.any()
    # One of four ways sees the other color; within the blurred texel two see half of it.
    assert found[near].min() > 0.3
    assert not found[~owned | (off > NEARBY + texel)].any()


def test_samples_are_drawn_again_where_there_is_detail() -> None:
    sampler = Sampler(printed(), 0)
    samples = sampler.surface(20_000)
    again = sampler.detailed(samples, 500)
    uvs = again.uv * sampler.table.uv_scale + sampler.table.uv_offset
    assert len(again) == 500
    assert np.abs(uvs[:, 0] - EDGE).max() < 2 * NEARBY
    assert set(map(bytes, again.points)) <= set(map(bytes, samples.points))


def test_nothing_is_drawn_again_without_a_texture() -> None:
    sampler = Sampler(printed(mapped=()), 0)
    assert len(sampler.detailed(sampler.surface(100), 50)) == 0


def test_charts_and_uvs_learn_some_points_again_charts_closer_to_the_surface(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in [each for each in vars(training) if each.endswith("_COUNT")]:
        monkeypatch.setattr(training, name, 1000)
    sets = training.training_sets(Sampler(printed(), 0))
    for samples in (sets.textured, sets.charts):
        assert len(samples) == 2000
        assert set(map(bytes, samples.points)) == set(map(bytes, samples.points[:1000]))
    assert np.abs(sets.charts.sdf).mean() < 0.7 * np.abs(sets.textured.sdf).mean()
