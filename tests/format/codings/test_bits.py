from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import bits
from nispcodec.format.codings.reader import Reader

FIELDS = st.lists(
    st.integers(0, 32).flatmap(
        lambda width: st.tuples(st.integers(0, 2**width - 1), st.just(width))
    ),
    max_size=20,
)


@given(FIELDS)
def test_they_are_the_binary_digits_one_after_the_other(fields: list[tuple[int, int]]) -> None:
    digits = "".join(f"{value:0{width}b}" for value, width in fields if width)
    digits += "0" * (-len(digits) % 8)
    wanted = bytes(int(digits[i : i + 8], 2) for i in range(0, len(digits), 8))
    values, widths = (np.array([field[part] for field in fields], "u4") for part in (0, 1))
    assert bits.encode(values, widths.astype(np.uint8)) == wanted


def test_too_few_bytes_are_refused() -> None:
    with pytest.raises(FormatError, match="low bits: expected 2 bytes, found 1 bytes left"):
        bits.decode(Reader("NETS", b"\xff"), "low bits", np.array([5, 4], np.uint8))


def test_what_follows_is_left_alone() -> None:
    reader = Reader("NETS", b"\xa0rest")
    assert bits.decode(reader, "low bits", np.array([3], np.uint8)).tolist() == [5]
    assert bytes(reader.rest()) == b"rest"
