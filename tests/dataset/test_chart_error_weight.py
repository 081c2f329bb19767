"""Confusion: samples are drawn again where a wrong chart shows another color, and only there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.dataset.chart_error_weight import chart_error_weight
from tests.geometry.shapes import box_asset
from tests.samplers import sampler_of


def painted(first: float, second: float) -> TexturedMesh:
    """The box, whose two materials have a gray each, linear, and no texture."""
    grays = ((value, value, value, 1.0) for value in (first, second))
    return replace(
        box_asset(),
        materials=tuple(Material(str(i), base_color=gray) for i, gray in enumerate(grays)),
        textures=(),
    )


def test_it_is_found_where_another_color_is_near_and_nowhere_else() -> None:
    sampler = sampler_of(painted(0, 1), 0)
    samples = sampler.surface(5000)
    found = chart_error_weight(painted(0, 1), sampler.analysis.table, samples, 16)
    white = sampler.analysis.table.materials[samples.chart] == 1
    gaps = np.linalg.norm(samples.points[white][:, None] - samples.points[~white], axis=2)
    assert 0 < (found > 0).sum() < len(found) / 2
    assert (found[white][gaps.min(axis=1) > 0.2] == 0).all()
    assert found[white][gaps.min(axis=1) < 0.01].min() > 0
    # Black and white differ by 1 in three channels of four.
    assert found.max() <= np.sqrt(3 / 4)


def test_charts_of_one_color_cannot_be_confused() -> None:
    sampler = sampler_of(painted(0.5, 0.5), 0)
    samples = sampler.surface(1000)
    assert len(np.unique(samples.chart)) > 1
    assert not chart_error_weight(painted(0.5, 0.5), sampler.analysis.table, samples, 16).any()
    assert len(sampler.by_chart_error(samples, 50)) == 0


def test_samples_are_drawn_again_where_it_is() -> None:
    sampler = sampler_of(painted(0, 1), 0)
    samples = sampler.surface(5000)
    again = sampler.by_chart_error(samples, 300)
    confused = chart_error_weight(painted(0, 1), sampler.analysis.table, samples, 16) > 0
    assert len(again) == 300
    assert set(map(bytes, again.points)) <= set(map(bytes, samples.points[confused]))
