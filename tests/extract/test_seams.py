"""Cutting along chart borders: every triangle in one chart, nothing torn."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network
from nispcodec.extract.isosurface import Surface, extract
from nispcodec.extract.seams import cut_along_seams
from nispcodec.extract.vertex_charts import vertex_charts
from nispcodec.infer.evaluate import classify, evaluate
from tests import tiny
from tests.extract.surfaces import areas, assert_sound

CHARTS = {"two": tiny.halves, "eight": tiny.octants}


@pytest.fixture(scope="module")
def ball() -> Network:
    return tiny.sphere()


@pytest.fixture(scope="module")
def surface(ball: Network) -> Surface:
    return extract(ball, 33)


@pytest.mark.parametrize("name", CHARTS)
def test_triangles_lie_in_one_chart(name: str, ball: Network, surface: Surface) -> None:
    chart = CHARTS[name]()
    cut, charts = cut_along_seams(ball, chart, surface, vertex_charts(chart, surface))
    assert_sound(cut.positions, cut.faces)
    assert len(charts) == len(cut.faces)
    corners = cut.positions[cut.faces]
    # Just inside each corner the field must answer the face's chart.
    inner = 0.9 * corners + 0.1 * corners.mean(axis=1, keepdims=True)
    agree = classify(chart, inner.reshape(-1, 3)).reshape(-1, 3) == charts[:, None]
    weight = areas(cut.positions, cut.faces)
    assert (weight[~agree.all(axis=1)]).sum() < 0.01 * weight.sum()


def test_two_charts_are_parted_exactly(ball: Network, surface: Surface) -> None:
    chart = tiny.halves()
    cut, charts = cut_along_seams(ball, chart, surface, vertex_charts(chart, surface))
    x = cut.positions[cut.faces][:, :, 0]
    tolerance = surface.cell * 0.03
    assert (x[charts == 0] < tolerance).all()
    assert (x[charts == 1] > -tolerance).all()
    assert np.abs(evaluate(ball, cut.positions)).max() < 1e-4


def test_uncut_surface_keeps_its_shape(ball: Network, surface: Surface) -> None:
    chart = tiny.octants()
    cut, _ = cut_along_seams(ball, chart, surface, vertex_charts(chart, surface))
    before, after = (areas(s.positions, s.faces).sum() for s in (surface, cut))
    assert after == pytest.approx(before, rel=2e-3)
    assert np.array_equal(cut.positions[: len(surface.positions)], surface.positions)


def test_specks_are_voted_away(surface: Surface) -> None:
    # A third chart that wins only within 0.0005 of one vertex of the surface.
    x, y, z = surface.positions[len(surface.positions) // 2].tolist()
    axes = np.vstack([np.eye(3), -np.eye(3)])
    first = np.vstack([[[1.0, 0, 0], [-1.0, 0, 0]], axes])
    bias = np.concatenate([[0.0, 0.0], -axes @ np.array([x, y, z])])
    last = np.zeros((3, 8))
    last[0, 1], last[1, 0], last[2, 2:] = 1.0, 1.0, -2000.0
    chart = tiny.relu_network([(first, bias), (last, np.array([0.0, 0.0, 1.0]))])
    assert (classify(chart, surface.positions) == 2).sum() == 1
    assert not (vertex_charts(chart, surface) == 2).any()


def test_overruled_votes_are_cut_in_the_middle(ball: Network, surface: Surface) -> None:
    chart = tiny.halves()
    charts = np.zeros(len(surface.positions), np.int32)
    charts[np.argmin(surface.positions[:, 0])] = 1
    cut, face_charts = cut_along_seams(ball, chart, surface, charts)
    assert_sound(cut.positions, cut.faces)
    assert set(face_charts.tolist()) == {0, 1}
