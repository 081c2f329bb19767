"""The computed case table: closed, oriented surfaces whatever the signs."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.extract.marching_cubes import CORNERS, EDGES, polygonize, triangle_table
from tests.extract.surfaces import assert_closed


def random_surface(seed: int, size: int = 10) -> tuple[np.ndarray, np.ndarray, int]:
    """Faces as grid-edge numbers, corner positions, number of inside points, of random signs."""
    rng = np.random.default_rng(seed)
    inside = np.zeros((size,) * 3, bool)
    inside[1:-1, 1:-1, 1:-1] = rng.random((size - 2,) * 3) < 0.5
    cases = np.zeros((size - 1,) * 3, np.uint8)
    for bit, (x, y, z) in enumerate(CORNERS):
        end = size - 1
        cases |= inside[x : x + end, y : y + end, z : z + end].astype(np.uint8) << bit
    cells, edges = polygonize(cases.ravel())
    low = np.array([corner for corner, _ in EDGES])[edges]
    axis = np.array([axis for _, axis in EDGES])[edges]
    cell = np.stack(np.unravel_index(cells, cases.shape), axis=1)[:, None] + CORNERS[low]
    numbers = np.ravel_multi_index((*cell.transpose(2, 0, 1), axis), (size, size, size, 3))
    return numbers, cell + 0.5 * np.eye(3)[axis], int(inside.sum())


@pytest.mark.parametrize("seed", range(5))
def test_random_signs_give_a_closed_oriented_manifold(seed: int) -> None:
    faces, corners, inside = random_surface(seed)
    assert_closed(faces)
    a, b, c = corners.transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert 0.5 * inside < volume < inside


def test_table_covers_every_crossed_edge_of_every_case() -> None:
    triangles, starts = triangle_table()
    assert starts[0] == starts[1] == 0
    assert starts[255] == starts[256] == len(triangles)
    for case in range(256):
        crossed = {
            number
            for number, (low, axis) in enumerate(EDGES)
            if (case >> low & 1) != (case >> (low | 1 << axis) & 1)
        }
        assert set(triangles[starts[case] : starts[case + 1]].ravel().tolist()) == crossed
