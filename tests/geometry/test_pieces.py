"""Pieces of one body, apart by a gap: those inside out are found, and sheets left alone."""

from __future__ import annotations

from collections import defaultdict

import numpy as np
import pytest

from nispcodec.core.arrays import BoolArray, Float64Array, IntArray
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.pieces import against_neighbors
from tests.geometry.shapes import grid, sphere

UP = np.array([0.0, 0.0, 1.0])
BALL = 0.6 * sphere()
LOWER = BALL[:, :, 2].mean(axis=1) < 0


def found(corners: Float64Array, body: IntArray, flipped: BoolArray | None = None) -> BoolArray:
    """Of faces (m, 3, 3), all of whose sides are given that no other face of their body has."""
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3).round(9)
    known: dict[object, list[int]] = defaultdict(list)
    for number, edge in enumerate(ends.tolist()):
        known[body[number // 3], str(sorted(edge))].append(number)
    sides = np.array([each[0] for each in known.values() if len(each) == 1], np.int64)
    wrong = np.zeros(len(corners), np.bool_) if flipped is None else flipped
    return against_neighbors(corners, wrong, sides, body, SolidConfig())


def halves(gap: float, turned: BoolArray) -> Float64Array:
    return np.where(turned[:, None, None], BALL[:, ::-1], BALL) - gap * LOWER[:, None, None] * UP


@pytest.mark.parametrize("gap", [1e-6, 1e-4, 9e-4])
def test_the_piece_that_looks_inwards_is_found(gap: float) -> None:
    for turned in (LOWER, ~LOWER):
        assert np.array_equal(found(halves(gap, turned), LOWER.astype(int)), turned)


def test_pieces_that_agree_are_left_as_they_are_whichever_way_they_look() -> None:
    for turned in (LOWER & False, LOWER | True):
        assert not found(halves(1e-4, turned), LOWER.astype(int)).any()


def test_what_is_known_to_be_turned_counts_as_turned() -> None:
    corners = halves(1e-4, LOWER)
    assert not found(corners, LOWER.astype(int), flipped=LOWER).any()


def test_pieces_far_apart_are_none() -> None:
    assert not found(halves(3e-3, LOWER), LOWER.astype(int)).any()


def test_sheets_on_each_other_hold_nothing_and_stay() -> None:
    sheet = 0.6 * grid()
    for other in (sheet, sheet[:, ::-1]):
        both = np.concatenate([sheet, other - 5e-4 * UP])
        assert not found(both, np.repeat([0, 1], len(sheet))).any()


def test_without_open_sides_nothing_is_asked() -> None:
    assert not found(BALL, np.zeros(len(BALL), int)).any()
