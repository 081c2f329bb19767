"""Simplification: fewer triangles, near the surface, still closed."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.network import Network
from nispcodec.extract.isosurface import Surface, extract
from nispcodec.extract.simplify import deviation, fitted, simplest, simplified, without_fins
from tests import tiny
from tests.extract.surfaces import assert_closed


@pytest.fixture(scope="module")
def ball() -> Network:
    return tiny.sphere()


@pytest.fixture(scope="module")
def surface(ball: Network) -> Surface:
    return extract(ball, 48)


@pytest.mark.parametrize("faces", [2000, 500, 100])
def test_count_and_closedness(ball: Network, surface: Surface, faces: int) -> None:
    fewer = simplified(ball, surface, faces)
    assert 0.9 * faces <= len(fewer.faces) <= faces
    assert_closed(fewer.faces)
    assert len(np.unique(fewer.faces)) == len(fewer.positions)
    radii = np.linalg.norm(fewer.positions, axis=1)
    np.testing.assert_allclose(radii, 0.6, atol=10 / faces)


def test_enough_is_enough(ball: Network, surface: Surface) -> None:
    assert simplified(ball, surface, len(surface.faces)) is surface


def test_fitting_brings_triangles_nearer_and_keeps_them(ball: Network, surface: Surface) -> None:
    # Vertices on a sphere: all triangles lie inside of it.
    coarse = extract(ball, 12)
    nearer = fitted(ball, coarse)
    assert np.array_equal(nearer.faces, coarse.faces)
    assert deviation(ball, nearer) < 0.5 * deviation(ball, coarse)
    moves = np.linalg.norm(nearer.positions - coarse.positions, axis=1)
    assert 0 < moves.max() < 0.1 * coarse.cell


def test_deviation_is_the_mean_distance(ball: Network, surface: Surface) -> None:
    swollen = Surface(surface.positions * np.float32(0.65 / 0.6), surface.faces, surface.cell)
    assert deviation(ball, surface) < 1e-3
    assert deviation(ball, swollen) == pytest.approx(0.05, abs=2e-3)
    assert deviation(ball, swollen, 500) == pytest.approx(0.05, abs=2e-3)


def test_simplest_keeps_to_the_error(ball: Network, surface: Surface) -> None:
    rough, fine = (simplest(ball, surface, error) for error in (1e-2, 2e-3))
    assert len(rough.faces) < len(fine.faces) < len(surface.faces)
    assert deviation(ball, rough) <= 1e-2
    assert deviation(ball, fine) <= 2e-3


def test_an_error_that_nothing_keeps_leaves_every_triangle(ball: Network, surface: Surface) -> None:
    assert simplest(ball, surface, 1e-9) is surface


def test_no_more_are_left_than_allowed_whatever_the_error(ball: Network, surface: Surface) -> None:
    bounded = simplest(ball, surface, 1e-9, 1000)
    assert 800 < len(bounded.faces) <= 1000
    assert_closed(bounded.faces)
    # Where the error lets fewer, there are fewer.
    assert len(simplest(ball, surface, 4e-3, 1000).faces) < len(bounded.faces)


def test_a_bound_beside_all_triangles_is_none(ball: Network, surface: Surface) -> None:
    beside = round(1.08 * len(surface.faces))
    bounded, free = (simplest(ball, surface, 2e-3, most) for most in (beside, None))
    assert len(bounded.faces) == len(free.faces) < len(surface.faces) / 2


def test_fins_go_and_everything_else_stays() -> None:
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    fin = np.array([[1, 2, 4], [4, 2, 1]])
    positions = np.arange(15, dtype=np.float32).reshape(5, 3)
    both = Surface(positions, np.vstack([fin, tetrahedron]).astype(np.int32), 0.1)
    cleaned = without_fins(both)
    assert np.array_equal(cleaned.faces, tetrahedron)
    assert np.array_equal(cleaned.positions, positions[:4])
    twice = Surface(positions, np.vstack([fin[:1], fin[:1]]).astype(np.int32), 0.1)
    assert len(without_fins(twice).faces) == 2
