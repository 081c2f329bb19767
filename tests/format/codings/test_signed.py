from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import signed
from nispcodec.format.codings.reader import Reader

HALVES = st.floats(width=16, allow_nan=False, allow_infinity=False)
SINGLES = st.floats(width=32, allow_nan=False, allow_infinity=False)


@given(st.one_of(*(st.lists(each, min_size=1, max_size=20) for each in (HALVES, SINGLES))))
def test_integers_keep_sign_and_order_and_give_the_weights_back(weights: list[float]) -> None:
    values = np.array(weights, np.float32)
    prefix, integers = signed.encode(values)
    np.testing.assert_array_equal(np.sign(integers), np.sign(values))
    filled = values != 0
    # The larger the weight, the smaller the integer; the largest of all is 1.
    by_size = np.argsort(-np.abs(values[filled]), kind="stable")
    assert (np.diff(np.abs(integers[filled][by_size])) >= 0).all()
    assert not filled.any() or np.abs(integers[filled]).min() == 1
    reader = Reader("NETS", prefix)
    kind, top = signed.read_top(reader)
    reader.finish()
    assert np.abs(integers).max() <= top
    np.testing.assert_array_equal(signed.decode_floats(kind, top, integers), values)


def test_symbols_stay_as_they_are() -> None:
    prefix, integers = signed.encode(np.array([3, 0, -7], np.int32))
    assert (prefix, integers.tolist()) == (b"", [3, 0, -7])


@pytest.mark.parametrize("data", [b"\x02\x80\xf8\x01", b"\x01\x80\x80\x80\xfc\x07"])
def test_infinity_cannot_be_the_largest(data: bytes) -> None:
    """0x7c00 and 0x7f800000 are the patterns of infinity."""
    with pytest.raises(FormatError, match=r"top: expected at most \d+, in the fewest bytes"):
        signed.read_top(Reader("NETS", data))
