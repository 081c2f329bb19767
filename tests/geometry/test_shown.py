from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.geometry.analysis import analyze
from nispcodec.geometry.shown import Shown, shown
from nispcodec.geometry.triangles import area, volumes
from tests.geometry.shapes import cube, grid, soup

BOX = cube((-1, -1, -1), 2.0)


def found(triangles: Float64Array) -> Shown:
    return shown(analyze(soup(triangles)))


def test_what_is_inside_another_body_is_not_shown() -> None:
    seen = found(np.concatenate([BOX, cube((-0.25, -0.25, -0.25), 0.5)]))
    assert seen.faces.tolist() == [True] * 12 + [False] * 12
    assert not seen.sheet.any()


def test_a_wall_that_is_wound_the_wrong_way_is_turned() -> None:
    broken = BOX.copy()
    broken[:2] = broken[:2, ::-1]
    seen = found(broken)
    assert abs(volumes(seen.mesh.corners).sum()) == np.float64(8)
    np.testing.assert_array_equal(
        np.sort(seen.mesh.corner_uvs, axis=1), np.sort(soup(broken).corner_uvs, axis=1)
    )


def test_a_sheet_is_a_sheet_as_a_whole() -> None:
    card = grid(4) * [1, 1, 0] + [0, 0, 3]
    seen = found(np.concatenate([BOX, card]))
    assert seen.faces.all()
    assert seen.sheet.tolist() == [False] * 12 + [True] * len(card)
    assert area(seen.mesh.corners).sum() == np.float64(24 + 4)


def test_what_is_seen_through_an_opening_is_shown() -> None:
    """A small box in a box without its top: inside by the winding number, and seen."""
    open_box = BOX[~(BOX[..., 2] == 1).all(axis=1)]
    inner = cube((-0.25, -0.25, -0.9), 0.5)
    seen = found(np.concatenate([open_box, inner]))
    assert seen.faces[len(open_box) :].sum() >= 10


def test_a_hidden_face_between_two_that_are_seen_is_kept() -> None:
    sunk = cube((-0.25, -0.25, 0.8), 0.5)
    seen = found(np.concatenate([BOX, sunk]))
    deepest = sunk[:, :, 2].max(axis=1) < 0.9
    assert deepest.sum() == 2
    assert seen.faces.all()
