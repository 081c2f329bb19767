from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import numbers
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import NUMBERS


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (65_504.0, "float16"),
        (65_520.0, "float32"),
        (2.0**-24, "float16"),
        (2.0**-25, "float32"),
        (1 / 3, "float32"),
    ],
)
def test_a_half_is_taken_only_where_it_loses_nothing(value: float, kind: str) -> None:
    assert numbers.smallest(np.array([0, value], np.float32)) == kind


@given(st.lists(st.integers(-(2**31), 2**31 - 1), min_size=1))
def test_symbols_take_the_fewest_bytes_that_hold_the_largest(values: list[int]) -> None:
    widths = {"int8": 1, "int16": 2, "int32": 4}
    needed = max((value if value >= 0 else ~value).bit_length() + 1 for value in values)
    array = np.array(values, np.int32)
    kind = numbers.smallest(array)
    assert widths[kind] == next(width for width in (1, 2, 4) if 8 * width >= needed)
    assert len(numbers.encode(array)) == 1 + len(values) * widths[kind]


@pytest.mark.parametrize("kind", NUMBERS)
def test_the_kind_must_be_of_the_sort_that_is_wanted(kind: str) -> None:
    data = bytes([1 + NUMBERS.index(kind)]) + bytes(4)
    whole = kind.startswith("int")
    found = numbers.decode(Reader("NETS", data), 1, symbols=whole)
    assert found.shape == (1,)
    assert found.dtype == (np.int32 if whole else np.float32)
    wanted = "float32, float16" if whole else "int8, int16, int32"
    with pytest.raises(FormatError, match="number_kind: expected one of") as caught:
        numbers.decode(Reader("NETS", data), 1, symbols=not whole)
    assert set(str(caught.value.expected).removeprefix("one of ").split(", ")) == set(
        wanted.split(", ")
    )
