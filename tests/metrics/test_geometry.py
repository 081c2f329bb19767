from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float64Array
from nispcodec.core.document import Frame
from nispcodec.metrics.geometry import (
    Matches,
    d1_psnr,
    d2_psnr,
    distance_summary,
    normal_consistency,
)
from nispcodec.metrics.psnr import CEILING
from nispcodec.metrics.surface import Surface, SurfacePoints
from tests.metrics.shapes import plane, sphere

UNIT = Frame((0.0, 0.0, 0.0), 1.0)


def flat() -> Surface:
    return Surface.of(plane(), UNIT)


def matches(surface: Surface, offsets: Float64Array) -> Matches:
    """Points of a surface, each with a counterpart that lies off by its offset."""
    points = surface.sample(len(offsets), np.random.default_rng(0))
    moved = SurfacePoints(points.faces, points.weights, points.positions + offsets)
    return Matches(points, moved)


def shifted(*offset: float, count: int = 50) -> Matches:
    return matches(flat(), np.tile(np.array(offset), (count, 1)))


def test_offsets_lead_from_the_original_to_the_decoded_point() -> None:
    both = shifted(3, 0, 0, count=2) + shifted(0, 0, -4, count=3)
    wanted = [[3, 0, 0]] * 2 + [[0, 0, -4]] * 3
    np.testing.assert_allclose(both.offsets, wanted, atol=1e-12)
    np.testing.assert_allclose(both.distances, [3, 3, 4, 4, 4])


@given(st.lists(st.floats(0, 100), min_size=1, max_size=30), st.floats(0.1, 10))
def test_a_summary_is_in_order_and_in_the_unit_of_its_distances(
    distances: list[float], unit: float
) -> None:
    found = distance_summary(np.array(distances))
    assert min(distances) <= found["p99"] <= found["max"] == max(distances)
    assert found["mean"] == pytest.approx(np.mean(distances), rel=1e-9)
    scaled = distance_summary(np.array(distances) * unit)
    assert scaled == pytest.approx({name: unit * value for name, value in found.items()})


def test_along_the_surface_counts_for_points_and_not_for_planes() -> None:
    sliding, lifted = shifted(0.01, 0, 0), shifted(0, 0, 0.01)
    assert d1_psnr([sliding], 1.0) == pytest.approx(40)
    assert d2_psnr(flat(), [sliding], 1.0) == CEILING
    assert d2_psnr(flat(), [lifted], 1.0) == pytest.approx(d1_psnr([lifted], 1.0))


def test_the_worse_direction_decides() -> None:
    near, far = shifted(0, 0, 0.001), shifted(0, 0, 0.1)
    for pair in ([near, far], [far, near]):
        assert d1_psnr(pair, 1.0) == pytest.approx(20)
        assert d2_psnr(flat(), pair, 1.0) == pytest.approx(20)


@given(st.integers(0, 99))
def test_planes_are_never_farther_than_points(seed: int) -> None:
    ball = Surface.of(sphere(subdivisions=1), UNIT)
    pairs = matches(ball, np.random.default_rng(seed).normal(0, 0.1, (20, 3)))
    assert d2_psnr(ball, [pairs], 2.0) >= d1_psnr([pairs], 2.0)


@pytest.mark.parametrize("turned", [False, True])
def test_normals_agree_whichever_way_they_point(turned: bool) -> None:
    mesh = plane()
    faces = mesh.faces[:, ::-1].copy() if turned else mesh.faces
    other = Surface(mesh.geometry_only(mesh.positions, faces, "other"), flat().positions)
    assert normal_consistency(flat(), other, shifted(0, 0, 0)) == pytest.approx(1)


def test_normals_at_an_angle_agree_by_its_cosine() -> None:
    tilt = np.radians(60)
    turn = np.array([[1, 0, 0], [0, np.cos(tilt), np.sin(tilt)], [0, -np.sin(tilt), np.cos(tilt)]])
    tilted = Surface(plane(), flat().positions @ turn)
    assert normal_consistency(flat(), tilted, shifted(0, 0, 0)) == pytest.approx(0.5)


def test_points_on_a_fine_surface_take_less_memory_than_its_corners() -> None:
    surface = Surface.of(plane(cells=400), UNIT)
    tracemalloc.start()
    surface.sample(10, np.random.default_rng(0))
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < surface.corners.nbytes
