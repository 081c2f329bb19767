"""Triangles: what is added up and set comes back, in half the memory."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.train.triangle import Triangle


@pytest.mark.parametrize("size", [1, 2, 7, 8])
def test_it_holds_the_sum_of_squares(size: int) -> None:
    rows = np.random.default_rng(0).normal(size=(20, size)).astype(np.float32)
    triangle = Triangle.zeros(size)
    for part in (rows[:12], rows[12:]):
        triangle.add(part, 0.5)
    assert np.triu(triangle.square()) == pytest.approx(np.triu(rows.T @ rows / 2), abs=1e-5)
    assert triangle.packed.size == size * (size + 1) // 2


@pytest.mark.parametrize("size", [1, 2, 7, 8])
def test_what_is_set_comes_back(size: int) -> None:
    square = np.random.default_rng(0).normal(size=(size, size)).astype(np.float32)
    triangle = Triangle.zeros(size)
    triangle.set(np.asfortranarray(square))
    assert (np.triu(triangle.square()) == np.triu(square)).all()
