from __future__ import annotations

import dataclasses

import numpy as np

from nispcodec.core.document import ChartTable, Document
from nispcodec.core.network import NetworkSpec
from nispcodec.infer.evaluate import evaluate
from nispcodec.infer.field import FieldQueries
from tests import tiny
from tests.tiny import field_of

POINTS = np.random.default_rng(0).uniform(-0.5, 0.5, (40, 3)).astype(np.float32)
CHARTS = (np.arange(40) % 2).astype(np.int32)
OFFSET, SCALE = (5.0, -1.0), (2.0, 0.5)


def asked(document: Document, points: np.ndarray, charts: np.ndarray) -> np.ndarray:
    return FieldQueries(field_of(document)).uv(points, charts)


def test_the_networks_uv_is_scaled_and_then_moved() -> None:
    plain = tiny.document()
    mapped = tiny.varied(
        plain, charts=dataclasses.replace(field_of(plain).charts, uv_offset=OFFSET, uv_scale=SCALE)
    )
    inner = asked(plain, POINTS, CHARTS)
    # The tiny UV is (y, z) / 4 + 1/4, and half a unit further in u on the second chart.
    wanted = POINTS[:, 1:] / 4 + 0.25 + np.column_stack([CHARTS / 2, 0 * CHARTS])
    np.testing.assert_allclose(inner, wanted, atol=1e-6)
    outer = asked(mapped, POINTS, CHARTS)
    np.testing.assert_allclose(outer, inner * SCALE + OFFSET, atol=1e-6)
    assert (inner.dtype, outer.dtype) == (np.dtype("f4"), np.dtype("f4"))


def test_a_chart_without_uv_answers_zero_whatever_the_map() -> None:
    plain = tiny.document()
    table = ChartTable(field_of(plain).charts.materials, np.array([True, False]), OFFSET, SCALE)
    found = asked(tiny.varied(plain, charts=table), POINTS, CHARTS)
    assert (found[CHARTS == 1] == 0).all()
    assert (found[CHARTS == 0] != 0).any(axis=1).all()


def test_a_network_that_knows_no_charts_is_asked_without_them() -> None:
    network = tiny.random_network(NetworkSpec((4,), 2))
    document = tiny.varied(tiny.document(), uv=network)
    found = asked(document, POINTS, CHARTS)
    np.testing.assert_array_equal(found, evaluate(network, POINTS))


def test_without_a_network_and_without_points() -> None:
    plain = tiny.document()
    table = ChartTable(field_of(plain).charts.materials, np.zeros(2, np.bool_))
    bare = tiny.varied(plain, charts=table, uv=None)
    np.testing.assert_array_equal(asked(bare, POINTS, CHARTS), np.zeros((40, 2), np.float32))
    for document in (plain, bare):
        assert asked(document, POINTS[:0], CHARTS[:0]).shape == (0, 2)
