from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import dia, numbers
from nispcodec.format.codings.reader import Reader

SHAPES = st.tuples(st.integers(1, 7), st.integers(1, 7))
SYMBOLS = st.sampled_from([0, 0, 0, 0, 5, -300])


@given(hnp.arrays(np.int32, SHAPES, elements=SYMBOLS))
def test_it_holds_the_diagonals_that_are_not_zero_from_the_lower_left(
    matrix: np.ndarray[Any, Any],
) -> None:
    rows, columns = matrix.shape
    every = {number: matrix.diagonal(number - rows + 1) for number in range(rows + columns - 1)}
    used = {number: values for number, values in every.items() if values.any()}
    gaps = (np.diff([-1, *used]) - 1).astype(np.uint8).tobytes()
    values = np.concatenate([np.zeros(0, np.int32), *used.values()])
    assert dia.encode(matrix) == bytes([len(used)]) + gaps + numbers.encode(values)


@pytest.mark.parametrize(
    ("payload", "text"),
    [
        (b"\x05", "diagonal_count: expected at most 4, in the fewest bytes, found 5"),
        (b"\x02\x03\x00", "diagonal: expected at most 3, found 4"),
        (b"\x01\x04", "diagonal_gap: expected at most 3, found 4"),
    ],
)
def test_diagonals_outside_the_matrix_are_refused(payload: bytes, text: str) -> None:
    with pytest.raises(FormatError, match=text):
        dia.decode(Reader("NETS", payload), (2, 3), symbols=True)
