"""Merging: charts that share a number are far apart or alike, and their UVs go together."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.geometry.chart_merging import Cover, merge_charts
from nispcodec.geometry.charts import Charts
from nispcodec.geometry.config import MergingConfig
from tests.geometry.shapes import CUBE_CORNERS, CUBE_FACES, soup
from tests.samplers import sampler_of

NO_PAIRS = np.zeros((0, 2), dtype=np.int64)


def line_of_charts(
    materials: list[int], places: list[float] | None = None, slopes: list[float] | None = None
) -> tuple[Charts, Cover]:
    """Charts of three points across a line, one apart; u grows by the chart's slope across it."""
    count = len(materials)
    numbers = np.repeat(np.arange(count, dtype=np.int32), 3)
    across = np.tile([-0.1, 0.0, 0.1], count)
    along = np.repeat(places or np.arange(count), 3)
    points = np.column_stack([along, across, np.zeros(3 * count)])
    uvs = np.column_stack([np.repeat(slopes or [0.0] * count, 3) * across, np.zeros(3 * count)])
    kinds = np.array(materials, np.int32)
    charts = Charts(np.arange(count, dtype=np.int32), kinds, np.ones(count, bool))
    return charts, Cover(points, numbers, points, uvs)


@given(st.lists(st.integers(0, 2), min_size=1, max_size=30), st.floats(0.3, 6))
def test_merged_charts_keep_apart_what_is_near_and_what_differs(
    materials: list[int], gap: float
) -> None:
    charts, cover = line_of_charts(materials)
    merged = merge_charts(charts, cover, NO_PAIRS, MergingConfig(gap=gap))
    assert merged.materials[merged.face_charts].tolist() == materials
    for one, label in enumerate(merged.face_charts):
        near = [n for n in range(len(materials)) if n != one and abs(n - one) <= gap]
        assert label not in merged.face_charts[near]


def test_charts_far_apart_share_a_number() -> None:
    charts, cover = line_of_charts([0] * 100)
    assert len(merge_charts(charts, cover, NO_PAIRS, MergingConfig(gap=1.5))) <= 6


def test_charts_share_a_number_with_those_whose_uvs_go_on_in_the_same_way() -> None:
    orders = [[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]] * 4
    slopes = [slope for order in orders for slope in order]
    places = [100.0 * (i // 3) + i % 3 for i in range(len(slopes))]
    merged = merge_charts(
        *line_of_charts([0] * len(slopes), places, slopes), NO_PAIRS, MergingConfig(gap=3.0)
    )
    kinds = {(int(n), slope) for n, slope in zip(merged.face_charts, slopes, strict=True)}
    assert len(kinds) == len(merged) == 3


def test_twins_share_a_number_though_they_touch() -> None:
    charts, cover = line_of_charts([0] * 6)
    merged = merge_charts(charts, cover, np.array([[2, 3], [3, 4]]), MergingConfig(gap=1.0))
    labels = merged.face_charts.tolist()
    assert labels[2] == labels[3] == labels[4]
    assert labels[2] not in (labels[1], labels[5])


def test_twins_of_two_materials_stay_apart() -> None:
    merged = merge_charts(*line_of_charts([0, 1]), np.array([[0, 1]]), MergingConfig(gap=0.3))
    assert merged.materials[merged.face_charts].tolist() == [0, 1]


@pytest.mark.parametrize("same", [True, False], ids=["same UVs", "other UVs"])
def test_mirrored_halves_with_the_same_uvs_are_one_chart(same: bool) -> None:
    """Two squares side by side, each with a chart of its own."""
    half = (CUBE_CORNERS * [0.8, 1, 0] + [0.1, 0, 0])[CUBE_FACES[8:10]]
    both = np.concatenate([half, half * [-1, 1, 1]])
    uvs = np.abs(both[..., :2]) if same else both[..., :2]
    sampler = sampler_of(soup(both, uvs), seed=0, gap=1.0)
    assert len(sampler.analysis.patches) == 2
    assert len(sampler.analysis.label.charts) == (1 if same else 2)


def test_more_numbers_than_needed_where_uvs_are_told_apart_by_them() -> None:
    """Charts far apart, which one number would do for, of two maps: two numbers."""
    slopes = [2.0, -2.0] * 6
    merged = merge_charts(*line_of_charts([0] * 12, None, slopes), NO_PAIRS, MergingConfig(gap=0.3))
    labels = merged.face_charts.tolist()
    assert labels[::2] == [labels[0]] * 6
    assert labels[1::2] == [labels[1]] * 6
    assert len(merged) == 2


def test_charts_that_were_met_first_are_looked_at_again() -> None:
    """The second of three numbers that go together is free only once all have been met."""
    slopes = [1.0, -1.0, 0.0, 0.0, 1.0, -1.0, -1.0, 0.0, 1.0]
    places = [100.0 * (i // 3) + i % 3 for i in range(9)]
    merged = merge_charts(
        *line_of_charts([0] * 9, places, slopes), NO_PAIRS, MergingConfig(gap=3.0)
    )
    assert len({(int(n), slope) for n, slope in zip(merged.face_charts, slopes, strict=True)}) == 3
