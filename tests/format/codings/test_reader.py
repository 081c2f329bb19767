from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.codings.reader import Reader, varint


@given(st.binary(max_size=30), st.lists(st.integers(0, 12), max_size=8))
def test_bytes_come_once_and_in_order_and_never_past_the_end(
    data: bytes, counts: list[int]
) -> None:
    reader, taken = Reader("NETS", data), b""
    for count in counts:
        if len(taken) + count > len(data):
            left = f"{len(data) - len(taken)} bytes left"
            with pytest.raises(FormatError, match=f"part: expected {count} bytes, found {left}"):
                reader.take(count, "part")
        else:
            taken += bytes(reader.take(count, "part"))
        assert reader.position == len(taken)
        assert taken + bytes(reader.rest()) == data


def test_an_error_says_section_and_place() -> None:
    reader = Reader("NETS", b"")
    reader.path = "uv.bias.1."
    error = reader.error("step", "more", 0)
    assert str(error) == "section NETS, field uv.bias.1.step: expected more, found 0"


@pytest.mark.parametrize("byte", [0, 2, 4, 255])
def test_a_member_must_be_known_and_allowed(byte: int) -> None:
    names = ("a", "b", "c")
    assert Reader("NETS", b"\x03").member("kind", names, ("a", "c")) == "c"
    with pytest.raises(FormatError, match=f"kind: expected one of a, c, found {byte}"):
        Reader("NETS", bytes([byte])).member("kind", names, ("a", "c"))


@given(st.integers(0, 2**35 - 1))
def test_an_integer_takes_a_byte_for_seven_bits(value: int) -> None:
    assert len(varint(value)) == max(1, -(-value.bit_length() // 7))


@pytest.mark.parametrize(
    ("data", "text"),
    [
        (b"\x80\x00", "at most 300, in the fewest bytes, found 0"),
        (b"\xad\x02", "at most 300, in the fewest bytes, found 301"),
        (b"\xff" * 6, "an integer of at most 5 bytes, found more"),
        (b"\xff", "1 bytes, found 0 bytes left"),
    ],
)
def test_an_integer_has_one_form_and_a_limit(data: bytes, text: str) -> None:
    assert Reader("NETS", b"\xac\x02").varint("size", 300) == 300
    with pytest.raises(FormatError, match=f"size: expected {text}"):
        Reader("NETS", data).varint("size", 300)


def test_bytes_that_are_left_are_an_error() -> None:
    reader = Reader("NETS", b"ab")
    reader.take(1, "part")
    with pytest.raises(FormatError, match="end: expected 1, found 2"):
        reader.finish()
