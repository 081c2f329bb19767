"""The fuzzer's `repair` leaves valid files alone and lets others past the checksums."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from nispcodec.format import pack
from nispcodec.format.container import read_container
from tests.format.documents import full, tiny
from tests.fuzz.repair import repair


def test_valid_files_stay() -> None:
    for document in (tiny(), full()):
        assert repair(pack(document)) == pack(document)


@given(st.integers(100, 140), st.integers(1, 255))
def test_a_changed_payload_passes_the_checksums(place: int, change: int) -> None:
    data = bytearray(pack(tiny()))
    data[place % len(data)] ^= change if place % len(data) >= 64 else 0
    entries = read_container(repair(bytes(data)))
    assert [entry.code for entry in entries] == ["META", "NETS"]


@given(st.binary(max_size=100))
def test_any_bytes_will_do(data: bytes) -> None:
    assert len(repair(data)) == len(data)
