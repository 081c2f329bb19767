"""Detail: samples are drawn again where the texture changes, and only there."""

from __future__ import annotations

from dataclasses import fields, replace
from io import BytesIO

import numpy as np
import PIL.Image

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.recipes import training_sets
from nispcodec.dataset.texture_gradient import texture_gradient
from tests.geometry.shapes import box_asset
from tests.samplers import sampler_of

STEP = SamplingConfig.texture_step
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
    sampler = sampler_of(mesh, 0)
    samples = sampler.surface(50_000)
    uvs = samples.uv * sampler.analysis.table.uv_scale + sampler.analysis.table.uv_offset
    off = np.abs(uvs[:, 0] - EDGE)
    owned = sampler.analysis.table.materials[samples.chart] == 0
    found = texture_gradient(mesh, sampler.analysis.table, samples, STEP)
    near, texel = owned & (off < 0.5 * STEP), 1 / 6000
    assert near.any()
    # One of four ways sees the other color; within the blurred texel two see half of it.
    assert found[near].min() > 0.3
    assert not found[~owned | (off > STEP + texel)].any()


def test_samples_are_drawn_again_where_there_is_detail() -> None:
    sampler = sampler_of(printed(), 0)
    samples = sampler.surface(20_000)
    again = sampler.by_texture_gradient(samples, 500)
    uvs = again.uv * sampler.analysis.table.uv_scale + sampler.analysis.table.uv_offset
    assert len(again) == 500
    assert np.abs(uvs[:, 0] - EDGE).max() < 2 * STEP
    assert set(map(bytes, again.points)) <= set(map(bytes, samples.points))


def test_nothing_is_drawn_again_without_a_texture() -> None:
    sampler = sampler_of(printed(mapped=()), 0)
    assert len(sampler.by_texture_gradient(sampler.surface(100), 50)) == 0


def test_charts_and_uvs_learn_some_points_again_charts_closer_to_the_surface() -> None:
    counts = {each.name: 1000 for each in fields(SamplingConfig) if each.name.endswith("_count")}
    sets = training_sets(sampler_of(printed(), config=SamplingConfig(**counts)))
    for samples in (sets.uvs, sets.charts):
        assert len(samples) == 2000
        assert set(map(bytes, samples.points)) == set(map(bytes, samples.points[:1000]))
    assert np.abs(sets.charts.sdf).mean() < 0.7 * np.abs(sets.uvs.sdf).mean()
