from __future__ import annotations

import math
import struct
from typing import Any

import msgpack
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format import canonical
from nispcodec.format.constants import MAX_DEPTH, MAX_ITEMS, MAX_METADATA, MAX_TEXT, MAX_VALUES

SCALARS = st.one_of(
    st.booleans(),
    st.integers(-(2**63), 2**64 - 1),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(st.characters(exclude_categories=["Cs"]), max_size=8),
    st.binary(max_size=8),
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4), st.dictionaries(st.integers(0, 300), inner, max_size=4)
    ),
    max_leaves=12,
)


def same(first: Any, second: Any) -> bool:
    """Equal, of one type, all the way down."""
    if type(first) is not type(second):
        return False
    if isinstance(first, dict):
        return first.keys() == second.keys() and all(same(first[k], second[k]) for k in first)
    if isinstance(first, list):
        return len(first) == len(second) and all(map(same, first, second))
    return bool(first == second)


@given(VALUES)
@settings(max_examples=60)
def test_any_value_comes_back_with_its_types(value: Any) -> None:
    data = canonical.encode("META", value)
    assert same(canonical.decode("META", data), value)
    assert same(msgpack.unpackb(data, strict_map_key=False), value)


@given(st.dictionaries(st.one_of(st.integers(-5, 300), st.text("ab", max_size=3)), st.integers()))
@settings(max_examples=40)
def test_the_order_in_which_a_map_was_made_means_nothing(values: dict[Any, int]) -> None:
    values = {key: value % 100 for key, value in values.items()}
    turned = dict(reversed(values.items()))
    assert canonical.encode("META", values) == canonical.encode("META", turned)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_float_is_short_only_where_that_loses_nothing(value: float) -> None:
    short = abs(value) < 3.5e38 and struct.unpack(">f", _single(value))[0] == value
    assert len(canonical.encode("META", value)) == (5 if short else 9)


def _single(value: float) -> bytes:
    try:
        return struct.pack(">f", value)
    except OverflowError:
        return struct.pack(">f", math.inf)


def nested(depth: int) -> list[Any]:
    value: list[Any] = []
    for _ in range(depth - 1):
        value = [value]
    return value


@pytest.mark.parametrize(
    ("largest", "beyond", "text"),
    [
        (nested(MAX_DEPTH), nested(MAX_DEPTH + 1), f"depth: expected at most {MAX_DEPTH}"),
        ([0] * MAX_ITEMS, [0] * (MAX_ITEMS + 1), f"array_length: expected at most {MAX_ITEMS}"),
        (
            dict.fromkeys(range(MAX_ITEMS), 0),
            dict.fromkeys(range(MAX_ITEMS + 1), 0),
            f"map_length: expected at most {MAX_ITEMS}",
        ),
        ("ä" * (MAX_TEXT // 2), "ä" * (MAX_TEXT // 2 + 1), f"text_length: .* {MAX_TEXT}, found"),
        (
            [[0] * 4090] * 4,
            [[0] * 4096] * 4,
            f"values: expected at most {MAX_VALUES}, found {MAX_VALUES + 1}",
        ),
        (
            bytes(MAX_METADATA - 5),
            bytes(MAX_METADATA - 4),
            f"length: expected at most {MAX_METADATA} bytes, found {MAX_METADATA + 1}",
        ),
        (2**64 - 1, 2**64, "value: expected a 64-bit integer or UTF-8 text"),
        (-(2**63), -(2**63) - 1, "value: expected a 64-bit integer or UTF-8 text"),
    ],
    ids=["depth", "array", "map", "text", "values", "bytes", "integer", "negative"],
)
def test_what_is_written_can_be_read_up_to_each_cap_and_not_beyond(
    largest: Any, beyond: Any, text: str
) -> None:
    assert canonical.decode("META", canonical.encode("META", largest)) == largest
    with pytest.raises(FormatError, match=text):
        canonical.encode("META", beyond)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ({1: None}, "type: expected map, array, text, bytes, number or bool, found NoneType"),
        ([{1, 2}], "found set"),
        (math.nan, "number: expected a finite number, found nan"),
        (-math.inf, "found -inf"),
    ],
)
def test_values_without_a_form_are_refused(value: Any, text: str) -> None:
    with pytest.raises(FormatError, match=f"section ABCD, field .*{text}"):
        canonical.encode("ABCD", value)
