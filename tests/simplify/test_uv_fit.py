"""UVs moved towards the source's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.errors import Original
from nispcodec.simplify.retreat import uv_areas
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from nispcodec.simplify.uv_fit import fitted_uvs
from tests.simplify.meshes import SMALL_FIT, ball, bare_ball


def median(source: Source, triangles: Triangles) -> float:
    original = Original.of(source.triangles, source.tree, 4000, 0)
    return original.errors(triangles.mesh()).uv_median


def test_uvs_come_nearer() -> None:
    source = Source(ball())
    fewer = collapsed(source.triangles, 80)
    moved = fitted_uvs(source, fewer, SMALL_FIT)
    assert median(source, moved) < 0.85 * median(source, fewer)
    assert (moved.uv_faces == fewer.uv_faces).all()


def test_wrong_uvs_come_back() -> None:
    source = Source(ball())
    given = source.triangles
    shaken = given.uvs + np.random.default_rng(0).normal(size=given.uvs.shape) * 0.001
    moved = fitted_uvs(source, replace(given, uvs=shaken), SMALL_FIT)
    assert np.median(np.abs(moved.uvs - given.uvs)) < 0.00002


def test_no_uv_triangle_turns_over() -> None:
    source = Source(ball())
    fewer = collapsed(source.triangles, 60)
    moved = fitted_uvs(source, fewer, SMALL_FIT)
    before, after = (uv_areas(each.uv_faces, each.uvs) for each in (fewer, moved))
    assert (before * after >= 0).all()


def test_without_uvs_nothing_happens() -> None:
    source = Source(bare_ball())
    assert fitted_uvs(source, source.triangles, SMALL_FIT) is source.triangles


def test_of_triangles_without_area_uvs_stay() -> None:
    source = Source(ball())
    flat = replace(ball(), positions=np.zeros_like(ball().positions))
    assert fitted_uvs(source, flat) is flat
