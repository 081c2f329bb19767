"""Membranes are found where the signed distance closes an opening, and only there."""

from __future__ import annotations

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.dataset.sampler import Sampler
from tests.geometry.shapes import cube, soup


def box(open_top: bool) -> TexturedMesh:
    """A cube, with or without the two triangles of its top."""
    triangles = cube((0.0, 0.0, 0.0), 1.0)
    lid = triangles[:, :, 2].min(axis=1) == 1
    return soup(triangles[~lid] if open_top else triangles)


def test_a_closed_body_has_no_openings() -> None:
    sampler = Sampler(box(open_top=False), 0, gap=0.1)
    assert not sampler.table.openings
    assert len(sampler.membrane(100)) == 0


def test_an_open_box_has_a_membrane_in_its_opening() -> None:
    sampler = Sampler(box(open_top=True), 0, gap=0.1)
    samples = sampler.membrane(500)
    assert sampler.table.openings
    assert not sampler.table.has_uv[-1]
    assert len(samples) > 400
    assert set(samples.chart.tolist()) == {len(sampler.table) - 1}
    top = sampler.field.solid.pieces.reshape(-1, 3)[:, 2].max()
    assert np.abs(samples.points[:, 2] - top).max() < top / 2
    assert np.abs(samples.points[:, :2]).max() < 1.05 * top


def test_the_paper_knows_no_openings() -> None:
    assert not Sampler(box(open_top=True), 0).table.openings
