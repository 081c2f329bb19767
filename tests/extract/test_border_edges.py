"""Charts that edges cross between their ends come out, and nothing is torn."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network
from nispcodec.extract.border_edges import with_borders_told
from nispcodec.extract.config import SeamConfig
from nispcodec.extract.isosurface import Surface, extract
from nispcodec.extract.seams import cut_along_seams
from nispcodec.extract.vertex_charts import vertex_charts
from nispcodec.infer.evaluate import classify
from tests import tiny
from tests.extract.surfaces import areas, assert_sound

RADIUS, PLACE, HALF = 0.6, 0.1, 0.01


@pytest.fixture(scope="module")
def ball() -> Network:
    return tiny.sphere(RADIUS)


@pytest.fixture(scope="module")
def surface(ball: Network) -> Surface:
    return extract(ball, 33)


def strip() -> Network:
    """Charts 0 and 1 left and right of `PLACE` along x; between them 2, a third of a cell wide."""
    sides = np.array([[-1.0, 0, 0], [1.0, 0, 0]])
    last = np.array([[1.0, 0], [0, 1.0], [0, 0]])
    bias = np.array([0.0, 0.0, HALF])
    return tiny.relu_network([(sides, np.array([PLACE, -PLACE])), (last, bias)])


def shown(ball: Network, surface: Surface) -> float:
    """The area of the strip once the surface is cut."""
    charts = vertex_charts(strip(), surface)
    cut, face_charts = cut_along_seams(ball, strip(), surface, charts)
    assert_sound(cut.positions, cut.faces)
    return float(areas(cut.positions, cut.faces)[face_charts == 2].sum())


def test_a_strip_narrower_than_a_cell_is_not_lost(ball: Network, surface: Surface) -> None:
    # Archimedes: of a ball's surface, a slice has as much as of the cylinder around it.
    true = 2 * np.pi * RADIUS * 2 * HALF
    told = with_borders_told(ball, strip(), surface)
    assert_sound(told.positions, told.faces)
    assert np.array_equal(told.positions[: len(surface.positions)], surface.positions)
    assert shown(ball, surface) < 0.1 * true
    assert 0.7 * true < shown(ball, told) < 1.1 * true


def test_no_edge_at_the_border_passes_a_third_chart(ball: Network, surface: Surface) -> None:
    told = with_borders_told(ball, strip(), surface, SeamConfig(splits=20))
    corners = told.positions[told.faces]
    middles = (corners + np.roll(corners, -1, axis=1)) * np.float32(0.5)
    ends = classify(strip(), told.positions)[told.faces]
    between = classify(strip(), middles.reshape(-1, 3)).reshape(-1, 3)
    assert ((between == ends) | (between == np.roll(ends, -1, axis=1))).all()


def test_where_ends_tell_everything_nothing_is_split(ball: Network, surface: Surface) -> None:
    assert with_borders_told(ball, tiny.halves(), surface) is surface
