"""Cells at borders of charts: no point with another chart within reach is left out."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.dataset.chart_borders import near_other_charts


@pytest.mark.parametrize("width", [0.02, 0.1, 5.0])
def test_no_point_with_another_chart_so_near_is_left_out(width: float) -> None:
    points = np.random.default_rng(0).uniform(-1, 1, (1500, 3)).astype(np.float32)
    charts = (points[:, 0] > 0.3).astype(np.int32) + 2 * (points[:, 1] > 0.5)
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    near = ((apart < width) & (charts[:, None] != charts)).any(axis=1)
    assert near_other_charts(points, charts, width)[near].all()


def test_points_far_from_borders_are_left_out() -> None:
    points = np.random.default_rng(0).uniform(-1, 1, (2000, 3)).astype(np.float32)
    charts = (points[:, 0] > 0).astype(np.int32)
    found = near_other_charts(points, charts, 0.1)
    assert found.any()
    assert np.abs(points[found, 0]).max() < 0.2 + 1e-6


def test_one_point_and_points_in_one_place_are_near_none_but_themselves() -> None:
    one, charts = np.ones((1, 3), np.float32), np.zeros(1, np.int32)
    assert not near_other_charts(one, charts, 0.1).any()
    assert not near_other_charts(one, charts, 0.0).any()
    both = near_other_charts(one.repeat(2, axis=0), np.array([0, 1], np.int32), 0.0)
    assert both.all()
