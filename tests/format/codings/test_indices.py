from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import indices
from nispcodec.format.codings.reader import Reader

MASKS = hnp.arrays(np.bool_, st.tuples(st.integers(1, 8), st.integers(1, 8)))


@pytest.mark.parametrize(
    ("maximum", "width"), [(0, 1), (255, 1), (256, 2), (65_535, 2), (65_536, 4)]
)
def test_the_width_is_that_of_the_largest_that_can_be(maximum: int, width: int) -> None:
    values = np.array([0, maximum], np.int64)
    data = indices.encode(values, maximum)
    assert len(data) == 2 * width
    np.testing.assert_array_equal(indices.decode(Reader("NETS", data), "gap", 2, maximum), values)


def test_an_index_beyond_the_largest_is_refused() -> None:
    with pytest.raises(FormatError, match="gap: expected at most 6, found 7"):
        indices.decode(Reader("NETS", b"\x06\x07"), "gap", 2, 6)


@given(MASKS)
def test_gaps_count_the_zeros_before_each_value_of_a_row(mask: np.ndarray[Any, Any]) -> None:
    gaps = indices.to_gaps(mask)
    counts = indices.row_counts(mask)
    wanted = []
    for row in mask:
        zeros = 0
        for filled in row:
            if filled:
                wanted.append(zeros)
            zeros = 0 if filled else zeros + 1
    assert gaps.tolist() == wanted
    found = indices.from_gaps(Reader("NETS", b""), counts, gaps, mask.shape[1])
    np.testing.assert_array_equal(found, np.nonzero(mask)[1])


def test_gaps_that_lead_out_of_the_row_are_refused() -> None:
    reader = Reader("NETS", b"")
    reader.path = "sdf.weight.0."
    with pytest.raises(FormatError, match=r"sdf\.weight\.0\.column: expected below 4, found 4"):
        indices.from_gaps(reader, np.array([0, 2]), np.array([2, 1]), 4)
