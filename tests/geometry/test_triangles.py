"""Measures of triangles that have known values."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.geometry.triangles import bulge, lattice, normals, turn, volumes
from tests.geometry.shapes import cube, grid, sphere


def test_a_sphere_bulges_as_a_sphere_does_and_a_plane_not_at_all() -> None:
    ball, sheet = sphere(), grid()
    both = np.concatenate([ball, sheet + 3.0])
    held = bulge(both, np.repeat([0, 1], [len(ball), len(sheet)]))
    assert held[0] == pytest.approx(4 / 3 * np.pi / (4 * np.pi) ** 1.5, rel=0.01)
    assert held[1] == pytest.approx(0, abs=1e-9)
    assert bulge(ball[:, ::-1], np.zeros(len(ball), int))[0] == pytest.approx(-held[0])


def test_turned_faces_look_the_other_way_and_others_stay() -> None:
    box = cube((0, 0, 0), 1.0)
    chosen = np.arange(len(box)) % 3 == 0
    found = turn(box, chosen)
    assert np.array_equal(normals(found)[chosen], -normals(box)[chosen])
    assert np.array_equal(found[~chosen], box[~chosen])
    assert volumes(turn(box, chosen | True)).sum() == pytest.approx(-1)


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_a_lattice_is_spread_evenly_over_its_triangle(rows: int) -> None:
    corner = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])
    (points,) = lattice(corner, rows)
    assert len(points) == rows**2
    assert len(np.unique(points.round(9), axis=0)) == rows**2
    assert points.mean(axis=0) == pytest.approx([1 / 3, 1 / 3, 0])
    assert (points[:, :2] > 0).all()
    assert (points.sum(axis=1) < 1).all()
    # In each cell below the diagonal lie two, in each that it cuts one.
    cells = np.floor(points[:, :2] * rows).astype(int)
    counts = np.bincount(cells[:, 0] * rows + cells[:, 1], minlength=rows**2).reshape(rows, rows)
    below = np.add.outer(np.arange(rows), np.arange(rows))
    assert np.array_equal(counts, np.where(below < rows - 1, 2, np.where(below == rows - 1, 1, 0)))
