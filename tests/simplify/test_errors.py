"""Errors of parts are those that `compare` gives."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from nispcodec.metrics.compare import Reference
from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.errors import Counted, Errors, Original, mesh_of
from nispcodec.simplify.quantize import quantized
from nispcodec.simplify.source import Source
from tests.geometry import shapes
from tests.simplify.meshes import ball, bare_ball, sheet, triangles_of


def test_the_same_as_compare() -> None:
    source = Source(ball())
    mesh = source.triangles.mesh()
    decoded = mesh_of(quantized(collapsed(source.triangles, 200), 10, 10))
    found = Original.of(source.triangles, source.tree, 8000, 0).errors(decoded)
    reference = Reference.of(mesh, samples=8000, seed=0)
    # Its normalized frame is that of the mesh, whose corners are not all at radius 1.
    report = reference.compare(decoded)
    geometry, uv = report["geometry"]["larger"], report["uv"]["larger"]
    assert isinstance(geometry, dict)
    assert isinstance(uv, dict)
    assert found.distance == pytest.approx(geometry["mean"], rel=0.02)
    assert found.distance_p99 == pytest.approx(geometry["p99"], rel=0.05)
    assert found.uv == pytest.approx(uv["mean"], rel=0.1)
    assert found.uv_median == pytest.approx(uv["median"], rel=0.05)


def test_nothing_changed_is_no_error() -> None:
    source = Source(sheet())
    errors = Original.of(source.triangles, source.tree, 2000, 0).errors(source.triangles.mesh())
    assert errors.within(1e-12, 1e-9)


def test_without_uvs_there_is_no_uv_error() -> None:
    source = Source(bare_ball())
    errors = Original.of(source.triangles, source.tree, 2000, 0).errors(source.triangles.mesh())
    assert errors.uv == errors.uv_median == 0


def test_only_counted_faces_are_looked_for() -> None:
    source = Source(ball())
    above = source.triangles.corners[..., 2].mean(axis=1) > 0
    half = source.triangles.only(above)
    counted = Original.of(source.triangles, source.tree, 2000, 0, Counted.of(above))
    assert counted.errors(half.mesh()).distance < 1e-9
    assert Original.of(source.triangles, source.tree, 2000, 0).errors(half.mesh()).distance > 0.1


def test_hidden_points_count_where_their_face_is_seen_and_then_as_lost_alone() -> None:
    inside = shapes.sphere(8) * 0.3
    both = triangles_of(shapes.soup(np.concatenate([shapes.sphere(8), inside])))
    source, inner = Source(both), np.arange(len(both)) >= len(both) - len(inside)
    outside = both.only(~inner).mesh()
    for seen, share in ((inner, 0.08), (np.zeros_like(inner), 0.0)):
        counted = Counted(np.ones(len(both), np.bool_), seen)
        errors = Original.of(both, source.tree, 4000, 0, counted).errors(outside)
        assert errors.distance < 1e-9
        assert errors.lost.share == pytest.approx(share, abs=0.02)


def test_what_is_missing_is_lost_and_what_is_too_much_is_made_up() -> None:
    source = Source(ball())
    half = source.triangles.only(source.triangles.corners[..., 2].mean(axis=1) > 0)
    errors = Original.of(source.triangles, source.tree, 2000, 0).errors(half.mesh())
    assert errors.lost.share == pytest.approx(0.5, abs=0.03)
    assert errors.lost.largest.center[2] < 0
    assert errors.made_up.share == 0
    other = Source(half)
    errors = Original.of(half, other.tree, 2000, 0).errors(source.triangles.mesh())
    assert errors.made_up.share == pytest.approx(0.5, abs=0.03)
    assert errors.lost.share == 0
    # What lies on faces that are hidden is not made up.
    below = source.triangles.corners[..., 2].mean(axis=1) <= 0
    hidden = Original.of(source.triangles, source.tree, 2000, 0, Counted.of(~below))
    assert hidden.errors(source.triangles.only(below).mesh()).made_up.share == 0


def test_errors_of_two_parts_are_weighted_by_their_areas() -> None:
    far = FaultyPoints(1000, np.zeros((10, 3)), np.zeros(10, np.int32))
    one, other = Errors(1e-3, 5e-3, 2e-3, 1e-3, 0.3, lost=far), Errors(3e-3, 4e-3, 6e-3, 5e-3, 0.1)
    both = one.beside(other, 0.25)
    means = both.distance, both.uv, both.uv_median
    assert means == pytest.approx((2.5e-3, 5e-3, 4e-3))
    assert both.distance_p99 == 5e-3
    assert both.color == pytest.approx(math.sqrt(0.25 * 0.3**2 + 0.75 * 0.1**2))
    assert (both.lost.share, both.made_up.share) == (0.0025, 0.0)


def test_both_means_must_be_within() -> None:
    errors = Errors(1e-3, 1.0, 2e-3, 1.0)
    assert errors.within(1e-3, 2e-3)
    assert not errors.within(0.9e-3, 2e-3)
    assert not errors.within(1e-3, 1.9e-3)


def test_nothing_with_an_area_is_infinitely_far() -> None:
    source = Source(ball(6))
    flat = replace(source.triangles, positions=np.zeros_like(source.triangles.positions))
    errors = Original.of(source.triangles, source.tree, 1000, 0).errors(flat.mesh())
    assert not errors.within(1e6, 1e6)
