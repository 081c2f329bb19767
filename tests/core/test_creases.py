from __future__ import annotations

import numpy as np

from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import (
    face_normals,
    fan_normals,
    sharp_sides,
    side_pairs,
    turned_sides,
)
from tests.geometry.shapes import cube, grid, sphere

CUBE = cube((-0.5, -0.5, -0.5), 1.0)
PLACES = row_ids(CUBE.reshape(-1, 3)).reshape(-1, 3)


def test_every_side_meets_the_other_of_its_edge() -> None:
    mine, other = side_pairs(PLACES)
    assert sorted(mine) == list(range(36))
    assert set(zip(mine, other, strict=True)) == set(zip(other, mine, strict=True))


def test_the_edges_of_a_cube_are_sharp_and_diagonals_are_not() -> None:
    sharp = sharp_sides(PLACES, CUBE)
    assert sharp.sum() == 24
    assert not sharp_sides(PLACES, CUBE, np.radians(100)).any()


def test_shading_breaks_over_creases_alone() -> None:
    rows, fans = fan_normals(PLACES, CUBE, sharp_sides(PLACES, CUBE))
    assert np.allclose(rows[fans], face_normals(CUBE)[:, None], atol=1e-12)
    rows, fans = fan_normals(PLACES, CUBE, np.zeros((12, 3), np.bool_))
    assert len(rows) == 8
    assert np.allclose(rows[fans], CUBE * 2 / np.sqrt(3))


def test_normals_of_a_sphere_point_outwards() -> None:
    ball = sphere()
    places = row_ids(ball.reshape(-1, 3)).reshape(-1, 3)
    rows, fans = fan_normals(places, ball, sharp_sides(places, ball))
    assert ((rows[fans] * ball).sum(axis=2) > 0.995).all()


def test_two_sheets_back_to_back_do_not_cancel() -> None:
    sheet = grid(3)
    both = np.concatenate([sheet, sheet[:, ::-1]])
    places = row_ids(both.reshape(-1, 3)).reshape(-1, 3)
    rows, fans = fan_normals(places, both, np.zeros((len(both), 3), np.bool_))
    assert np.allclose(rows[fans][..., 2], np.repeat([1.0, -1.0], len(sheet))[:, None])


def test_faces_wound_the_other_way_have_the_same_creases() -> None:
    creases = sharp_sides(PLACES, CUBE)
    swapped = [0, 2, 1]
    turned = sharp_sides(PLACES[:, swapped], CUBE[:, swapped])
    assert np.array_equal(turned, turned_sides(creases))
