from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.core.initial_weights import BITS, initial_integers, predicted
from nispcodec.core.network import MAX_ROW_SHIFT
from nispcodec.format.constants import MAX_SYMBOL
from nispcodec.format.tensor import Tensor

SHAPES = st.tuples(st.integers(1, 5), st.integers(1, 6))


def tensor(symbols: Any, step: float | None = 0.5) -> Tensor:
    matrix = np.array(symbols, np.int32)
    return Tensor("uv", step, matrix, initial_integers(3, 0, matrix.size).reshape(matrix.shape))


@given(hnp.arrays(np.int32, SHAPES, elements=st.integers(-MAX_SYMBOL, MAX_SYMBOL)))
def test_row_shifts_are_the_largest_that_lose_nothing(matrix: np.ndarray[Any, Any]) -> None:
    found = tensor(matrix)
    shifts = found.row_shifts
    assert (shifts.shape, shifts.min() >= 0) == ((len(matrix),), True)
    np.testing.assert_array_equal(found.values(shifts, delta=False) << shifts[:, None], matrix)
    for row, shift in zip(matrix.tolist(), shifts.tolist(), strict=True):
        assert shift == MAX_ROW_SHIFT or any(symbol % (2 << shift) for symbol in row)


@pytest.mark.parametrize("scale", [0, 1, 900, MAX_SYMBOL])
def test_symbols_that_are_still_the_initial_weights_leave_nothing_to_say(scale: int) -> None:
    initial = initial_integers(3, 0, 60).reshape(6, 10)
    found = Tensor("uv", 0.5, predicted(initial, scale, np.zeros(1, int)).astype("i4"), initial)
    assert found.init_scale == pytest.approx(scale, abs=1)
    assert np.abs(found.values(np.zeros(6, np.int64), delta=True)).max() <= 1


@given(hnp.arrays(np.int32, SHAPES, elements=st.integers(-MAX_SYMBOL, MAX_SYMBOL)))
def test_what_is_left_of_a_prediction_is_a_symbol(matrix: np.ndarray[Any, Any]) -> None:
    found = tensor(matrix)
    shifts = found.row_shifts
    assert 0 <= found.init_scale <= MAX_SYMBOL
    rest = found.values(shifts, delta=True)
    assert np.abs(rest).max() <= MAX_SYMBOL
    back = rest + predicted(found.initial, found.init_scale, shifts[:, None]) << shifts[:, None]
    np.testing.assert_array_equal(back, matrix)


def test_weights_that_are_not_quantized_stay() -> None:
    weights = np.array([[0.5, -2.0]], np.float32)
    found = Tensor("uv", None, weights, np.full((1, 2), 1 << BITS - 1))
    assert (found.init_scale, found.row_shifts.tolist()) == (0, [0])
    assert found.values(found.row_shifts, delta=True) is weights


def test_a_tensor_that_began_at_zero_is_not_predicted() -> None:
    """As the one bias of a network may, for some seeds: nothing to divide by."""
    found = Tensor("sdf.bias.1", 0.5, np.array([[3]], np.int32), np.zeros((1, 1), np.int64))
    assert found.init_scale == 0
    np.testing.assert_array_equal(found.values(np.zeros(1, np.int64), delta=True), [[3]])


def test_a_prediction_that_leads_too_far_is_none() -> None:
    """The best scale for both would take the second beyond the largest symbol."""
    initial = np.array([[9, -1]]) * (1 << BITS) // 10
    symbols = np.full((1, 2), MAX_SYMBOL, np.int32)
    assert Tensor("uv", 0.5, symbols, initial).init_scale == 0
    assert Tensor("uv", 0.5, symbols // 2, initial).init_scale > 0
