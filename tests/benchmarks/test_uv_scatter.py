"""UVs as they are beside UVs as predicted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib", reason="plots: extra `bench`")

from benchmarks.paper.uv_scatter import FAR, Scatter, asked, draw, measure, scatter
from nispcodec.model import NispModel
from tests import tiny


def made_up() -> Scatter:
    """Of four points one is far off where no chart is told, none where one is."""
    right = np.array([[0.1, 0.1], [0.2, 0.1], [0.3, 0.1], [0.4, 0.1]])
    off = right + np.array([[0, 0], [0, 0], [FAR / 2, 0], [0, 2 * FAR]])
    return Scatter(right, {"unconditioned": off, "conditioned": right + np.array([FAR / 4, 0])})


def test_far_is_what_is_farther_than_the_limit() -> None:
    numbers = made_up().numbers("unconditioned")
    assert numbers["far"] == 0.25
    assert numbers["mean"] == pytest.approx(2.5 * FAR / 4)


def test_an_asset_of_several_charts_is_asked_to_gain_by_them() -> None:
    model = NispModel(tiny.document())
    record = measure(model, made_up())
    assert record["ratio"]["far"] == 0
    several = {"assets": {"a": record | {"charts": 2}}}
    assert [each.verdict for each in asked(several)] == ["met", "met"]
    assert not list(asked({"assets": {"a": record | {"charts": 1}}}))


def test_a_model_is_asked_where_the_surface_has_uvs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmarks.paper.uv_scatter.POINTS", 200)
    from nispcodec.metrics.surface import Surface

    model = NispModel(tiny.document())
    mesh = model.to_mesh(16)
    found = scatter(Surface.of(mesh, model.document.frame), {"conditioned": model})
    assert 0 < len(found.right) == len(found.predicted["conditioned"]) <= 200
    assert np.median(found.errors("conditioned")) < 0.05


def test_the_figure_has_a_row_for_each_asset(tmp_path: Path) -> None:
    heights = []
    for count in (1, 2):
        draw({f"asset {i}": made_up() for i in range(count)}, tmp_path / "figure.png")
        from PIL import Image

        heights.append(Image.open(tmp_path / "figure.png").height)
    assert heights[1] == 2 * heights[0]
