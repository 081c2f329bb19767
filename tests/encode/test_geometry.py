"""Whole encodes as triangles, and as what is smaller."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import nispcodec
from nispcodec import EncodeConfig
from nispcodec.core.errors import NispError
from nispcodec.metrics.compare import compare
from tests.encode.tunings import small
from tests.geometry.shapes import box_asset, grid, soup

SHORT = small(3000, 60, 1, 100, 30, lambda_=1e-6)


def test_a_box_stays_a_box(tmp_path: Path) -> None:
    """Twelve triangles come back as twelve, with sharp edges and exact seams."""
    mesh = box_asset()
    model = nispcodec.encode(mesh, EncodeConfig(geometry="mesh"))
    nispcodec.save(model, tmp_path / "box.nisp")
    assert (tmp_path / "box.nisp").stat().st_size < 450
    loaded = nispcodec.load(tmp_path / "box.nisp")
    back = loaded.to_mesh()
    assert len(back.faces) == 12
    report = compare(mesh, back, samples=5000)
    assert report["geometry"]["larger"]["max"] < 1e-3  # type: ignore[index]
    assert report["uv"]["larger"]["mean"] < 1e-3  # type: ignore[index]
    points = np.random.default_rng(0).uniform(-1, 1, (200, 3))
    np.testing.assert_array_equal(loaded.sdf(points), model.sdf(points))
    assert (loaded.sdf(0.9 * points) < 0).all()
    assert "engine" not in loaded.document.info


@pytest.mark.slow
def test_the_smaller_form_is_written() -> None:
    # So few triangles would be taken without a look at networks.
    tuning = replace(SHORT, forms=replace(SHORT.forms, surely_best=-math.inf))
    model = nispcodec.encode(box_asset(), EncodeConfig(), tuning=tuning)
    assert model.document.field is None
    assert float(model.document.info["other_form_bytes"]) > 0
    field = nispcodec.encode(box_asset(), EncodeConfig(geometry="field"), tuning=SHORT)
    assert field.document.meshes == ()


def test_networks_of_a_box_are_not_looked_at() -> None:
    model = nispcodec.encode(box_asset(), EncodeConfig(), tuning=SHORT)
    assert model.document.field is None
    assert "other_form_bytes" not in model.document.info


def test_a_card_is_a_sheet_without_thickness() -> None:
    card = nispcodec.encode(soup(grid(8)), EncodeConfig(geometry="mesh"))
    heights = np.array([[0.1, 0.1, -0.2], [0.1, 0.1, 0.0], [0.1, 0.1, 0.2]])
    np.testing.assert_allclose(card.sdf(heights), [0.2, 0.0, 0.2], atol=1e-4)
    assert card.document.meshes[0].sheet.all()


def test_the_same_input_and_seed_give_the_same_bytes() -> None:
    first, again = (
        nispcodec.encode(box_asset(), EncodeConfig(geometry="mesh", seed=3)) for _ in range(2)
    )
    np.testing.assert_array_equal(
        first.document.meshes[0].positions, again.document.meshes[0].positions
    )


@pytest.mark.parametrize("options", [{"preset": "paper"}, {"prune": "smallest"}])
def test_triangles_have_no_networks_to_publish_or_prune(options: dict[str, str]) -> None:
    with pytest.raises(NispError, match="geometry mesh"):
        EncodeConfig(geometry="mesh", **options)  # type: ignore[arg-type]
