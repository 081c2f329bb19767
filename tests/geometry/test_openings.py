"""Membranes are found where the signed distance closes an opening, and only there."""

from __future__ import annotations

import numpy as np

from nispcodec.core.asset import TexturedMesh
from tests.geometry.shapes import cube, soup
from tests.samplers import analysis_of, sampler_of


def box(open_top: bool) -> TexturedMesh:
    """A cube, with or without the two triangles of its top."""
    triangles = cube((0.0, 0.0, 0.0), 1.0)
    lid = triangles[:, :, 2].min(axis=1) == 1
    return soup(triangles[~lid] if open_top else triangles)


def test_a_closed_body_has_no_openings() -> None:
    sampler = sampler_of(box(open_top=False), 0, gap=0.1)
    assert not sampler.analysis.table.openings
    assert len(sampler.closing_surface(100)) == 0


def test_an_open_box_has_a_membrane_in_its_opening() -> None:
    sampler = sampler_of(box(open_top=True), 0, gap=0.1)
    samples = sampler.closing_surface(500)
    assert sampler.analysis.table.openings
    assert not sampler.analysis.table.has_uv[-1]
    assert len(samples) > 400
    assert set(samples.chart.tolist()) == {len(sampler.analysis.table) - 1}
    top = sampler.analysis.field.solid.pieces.reshape(-1, 3)[:, 2].max()
    assert np.abs(samples.points[:, 2] - top).max() < top / 2
    assert np.abs(samples.points[:, :2]).max() < 1.05 * top


def test_the_paper_knows_no_openings() -> None:
    assert not analysis_of(box(open_top=True)).table.openings
