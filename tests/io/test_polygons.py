from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.io.read.polygons import triangulate

Shape = Sequence[tuple[float, float]]
SHAPES: dict[str, Shape] = {
    "square": [(0, 0), (1, 0), (1, 1), (0, 1)],
    "arrow": [(0, 0), (2, 1), (0, 2), (1, 1)],
    "arrow from its notch": [(1, 1), (0, 0), (2, 1), (0, 2)],
    "L": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "U": [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)],
    "square with a point on its edge": [(0, 0), (0.5, 0), (1, 0), (1, 1), (0, 1)],
    "comb": [(0, 0), (5, 0), (5, 2), (4, 1), (3, 2), (2, 1), (1, 2), (0, 1)],
}


def normals(points: Float64Array, triangles: Int64Array) -> Float64Array:
    a, b, c = points[triangles[:, 0]], points[triangles[:, 1]], points[triangles[:, 2]]
    return np.cross(b - a, c - a)


def polygon_area(shape: Shape) -> float:
    x, y = np.array(shape, dtype=float).T
    return float(0.5 * abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


@pytest.mark.parametrize("clockwise", [False, True])
@pytest.mark.parametrize("name", SHAPES)
def test_triangles_cover_the_polygon_once_with_its_orientation(name: str, clockwise: bool) -> None:
    shape = SHAPES[name][::-1] if clockwise else SHAPES[name]
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    points = np.column_stack([np.array(shape, dtype=float), np.full(len(shape), 7.0)]) @ turn.T
    triangles, owner = triangulate(points, np.array([len(shape)]))
    facing = normals(points, triangles) @ turn[:, 2] * (-1 if clockwise else 1)
    assert (facing > 1e-12).all()
    assert facing.sum() / 2 == pytest.approx(polygon_area(shape))
    assert owner.tolist() == [0] * (len(shape) - 2)


def test_mixed_sizes_keep_the_order_of_their_polygons() -> None:
    flat = np.array([(0, 0), (1, 0), (0, 1), *SHAPES["arrow"], (5, 5), (6, 5), (5, 6)], dtype=float)
    points = np.column_stack([flat, np.zeros(len(flat))])
    triangles, owner = triangulate(points, np.array([3, 4, 3]))
    assert owner.tolist() == [0, 1, 1, 2]
    assert triangles[0].tolist() == [0, 1, 2]
    assert triangles[3].tolist() == [7, 8, 9]
    assert set(triangles[1:3].flatten()) == {3, 4, 5, 6}


def test_no_polygons() -> None:
    triangles, owner = triangulate(np.zeros((0, 3)), np.zeros(0, dtype=np.int64))
    assert triangles.shape == (0, 3)
    assert owner.shape == (0,)


@given(st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=3, max_size=12))
def test_any_polygon_gives_two_triangles_fewer_than_corners(
    corners: list[tuple[int, int, int]],
) -> None:
    points = np.array(corners, dtype=float)
    triangles, _ = triangulate(points, np.array([len(corners)]))
    assert triangles.shape == (len(corners) - 2, 3)
    assert set(triangles.flatten()) == set(range(len(corners)))


@pytest.mark.filterwarnings("error")
def test_absurd_coordinates_pass_in_silence() -> None:
    points = np.array([(0, 0, 0), (1e300, 0, 0), (1e300, 1e300, 0), (0, 1e300, 0)])
    assert len(triangulate(points, np.array([4]))[0]) == 2
