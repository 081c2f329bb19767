"""SOAP's first bases: orthonormal, the gradient's own directions first, steady under rounding."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.train.soap_bases import bases


def gradient(rows: int, columns: int) -> np.ndarray:
    return np.random.default_rng(0).normal(size=(rows, columns)).astype(np.float32)


@pytest.mark.parametrize("shape", [(24, 4), (1, 25), (3, 15), (6, 6)])
def test_bases_are_orthonormal_and_make_the_gradient_diagonal(shape: tuple[int, int]) -> None:
    found = gradient(*shape)
    left, right = bases(found)
    for basis, size in zip((left, right), shape, strict=True):
        assert basis @ basis.T == pytest.approx(np.eye(size), abs=1e-5)
    inner = np.abs(left.T @ found @ right)
    values = inner.diagonal()
    assert inner.sum() == pytest.approx(values.sum(), abs=1e-3)
    assert (np.diff(values) <= 0).all()


def test_a_difference_in_the_last_bit_changes_them_no_more_than_that() -> None:
    found = gradient(24, 4)
    near = found * (1 + 1e-7 * gradient(24, 4))
    for one, other in zip(bases(found), bases(near.astype(np.float32)), strict=True):
        assert np.abs(one - other).max() < 1e-5


def test_no_gradient_at_all_gives_bases_too() -> None:
    left, right = bases(np.zeros((5, 3), np.float32))
    assert np.array_equal(np.abs(left), np.eye(5))
    assert np.array_equal(np.abs(right), np.eye(3))
