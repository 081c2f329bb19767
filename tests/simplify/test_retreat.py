"""Moves taken back where faces would turn over."""

from __future__ import annotations

import numpy as np

from nispcodec.simplify.retreat import uv_areas, without_folds, without_turns

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def test_a_move_that_turns_nothing_over_stays() -> None:
    moved = SQUARE + np.array([0.1, 0.2, 0.3])
    assert (without_turns(FACES, SQUARE, moved, 0.3, 3) == moved).all()


def test_a_face_that_turns_over_goes_back() -> None:
    moved = SQUARE.copy()
    moved[1] = [-1, 2, 0]
    back = without_turns(FACES, SQUARE, moved, 0.3, 3)
    assert back[1, 0] > back[1, 1] - 1e-9
    assert (back[3] == SQUARE[3]).all()


def test_uvs_that_fold_go_back() -> None:
    uvs = SQUARE[:, :2]
    moved = uvs.copy()
    moved[3] = [2, -1]
    back = without_folds(FACES, uvs, moved, 3)
    assert (uv_areas(FACES, back) > 0).all()
