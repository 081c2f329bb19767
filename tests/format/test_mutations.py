"""No byte string does anything but unpack or raise `FormatError`."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format import pack, unpack
from nispcodec.format.codings.registry import CODINGS
from nispcodec.format.container import content, read_container
from tests.conformance.builder import Row, change, container
from tests.format.documents import full, tiny

FILES = [pack(full(), coding) for coding in (None, *CODINGS)]


def raw_rows(data: bytes) -> list[Row]:
    """The sections of a file, unpacked, ready to be written again with true checksums."""
    return [
        Row(entry.code.encode(), bytes(content(entry)), flags=int(entry.critical))
        for entry in read_container(data)
    ]


def survives(data: bytes) -> None:
    """The bytes are refused in the proper way, or make a document that can be written."""
    try:
        document = unpack(data)
    except FormatError:
        return
    assert unpack(pack(document, "dense")).frame == document.frame


@pytest.mark.parametrize("data", [pack(tiny()), FILES[0]], ids=["tiny", "full"])
def test_truncation_at_every_byte(data: bytes) -> None:
    for length in range(len(data)):
        with pytest.raises(FormatError):
            unpack(data[:length])


def test_every_single_byte_change() -> None:
    data = pack(tiny())
    for position, byte in enumerate(data):
        for changed in set(range(256)) - {byte}:
            with pytest.raises(FormatError):
                unpack(data[:position] + bytes([changed]) + data[position + 1 :])


def test_every_byte_of_a_larger_file_changed() -> None:
    for position, byte in enumerate(FILES[0]):
        with pytest.raises(FormatError):
            unpack(FILES[0][:position] + bytes([byte ^ 0xFF]) + FILES[0][position + 1 :])


@pytest.mark.parametrize("code", [b"META", b"NETS"])
def test_every_single_bit_change_under_true_checksums(code: bytes) -> None:
    rows = raw_rows(pack(tiny()))
    payload = next(row.payload for row in rows if row.code == code)
    for place in range(8 * len(payload)):
        mutated = bytearray(payload)
        mutated[place // 8] ^= 1 << place % 8
        with suppress(FormatError):
            unpack(container(change(rows, code, payload=bytes(mutated))))


@pytest.mark.parametrize(
    ("data", "code"),
    [(FILES[0], b"META"), *((data, b"NETS") for data in FILES[1:])],
    ids=["META", *CODINGS],
)
def test_every_single_byte_of_the_content_changed(data: bytes, code: bytes) -> None:
    rows = raw_rows(data)
    payload = next(row.payload for row in rows if row.code == code)
    for position in range(len(payload)):
        mutated = bytearray(payload)
        mutated[position] ^= 1 << position % 8
        with suppress(FormatError):
            unpack(container(change(rows, code, payload=bytes(mutated))))


@given(st.binary(max_size=200))
def test_noise(data: bytes) -> None:
    survives(data)
    survives(FILES[0][:8] + data)


@given(st.data())
@settings(max_examples=300)
def test_spliced_content(data: st.DataObject) -> None:
    rows = raw_rows(data.draw(st.sampled_from(FILES)))
    index = data.draw(st.integers(0, len(rows) - 1))
    payload = rows[index].payload
    start = data.draw(st.integers(0, len(payload)))
    end = data.draw(st.integers(start, min(len(payload), start + 6)))
    payload = payload[:start] + data.draw(st.binary(max_size=6)) + payload[end:]
    changed = Row(rows[index].code, payload, rows[index].flags)
    survives(container([*rows[:index], changed, *rows[index + 1 :]]))
