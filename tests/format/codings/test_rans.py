from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.format.codings import rans
from nispcodec.format.codings.reader import Reader

SURE = np.array([0, rans.SCALE])
EVEN = np.array([0, rans.SCALE // 2, rans.SCALE])


def coins(tokens: list[int]) -> bytes:
    return rans.encode([int(EVEN[each]) for each in tokens], [rans.SCALE // 2] * len(tokens))


def test_what_is_certain_takes_no_more_than_the_state() -> None:
    data = rans.encode([0] * 1000, [rans.SCALE] * 1000)
    assert len(data) == 4
    reader = Reader("NETS", data)
    assert not rans.decode(reader, [(1000, SURE)]).any()
    reader.finish()


@pytest.mark.parametrize("count", [1, 16, 17, 1000])
def test_the_toss_of_a_coin_takes_a_bit(count: int) -> None:
    tokens = np.random.default_rng(0).integers(0, 2, count).tolist()
    data = coins(tokens)
    assert len(data) == 4 + 2 * (count // 16)
    assert rans.decode(Reader("NETS", data), [(count, EVEN)]).tolist() == tokens


def test_no_tokens_take_nothing() -> None:
    assert rans.encode([], []) == b""
    reader = Reader("NETS", b"rest")
    assert rans.decode(reader, [(0, EVEN)]).shape == (0,)
    assert reader.position == 0


@pytest.mark.parametrize("count", [100, rans.LONG])
def test_what_follows_is_left_alone(count: int) -> None:
    """Whether one state reads, or many in turns."""
    tokens = np.random.default_rng(1).integers(0, 2, count).tolist()
    reader = Reader("NETS", coins(tokens) + b"odd")
    assert rans.decode(reader, [(count, EVEN)]).tolist() == tokens
    assert bytes(reader.rest()) == b"odd"


@pytest.mark.parametrize("count", [100, rans.LONG])
def test_broken_streams_are_refused(count: int) -> None:
    data = coins([1] * count)
    with pytest.raises(FormatError, match="words: expected as many as the tokens need"):
        rans.decode(Reader("NETS", data[:-2]), [(count, EVEN)])
    with pytest.raises(FormatError, match="final_state: expected 65536"):
        rans.decode(Reader("NETS", data[:-2] + b"\x55\x55"), [(count, EVEN)])


def test_states_take_turns_only_in_long_streams() -> None:
    assert {rans.lanes(count) for count in (1, rans.LONG - 1)} == {1}
    assert rans.lanes(rans.LONG) == rans.LONG >> rans.TURNS_BITS > 1


@pytest.mark.parametrize("count", [1, rans.LONG])
def test_a_stream_begins_with_states_that_an_encoder_ends_with(count: int) -> None:
    table = np.array([0, 8000, rans.SCALE])
    data = bytearray(rans.encode([0] * count, [8000] * count))
    data[0:2] = bytes(2)
    with pytest.raises(FormatError, match="first_state: expected at least 65536"):
        rans.decode(Reader("NETS", bytes(data)), [(count, table)])
