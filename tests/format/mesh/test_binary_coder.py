"""The range coder gives back what went in, in few bits where it can be foreseen."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.format.mesh.binary_coder import BinaryCoder, Decoder, Encoder

Call = tuple[str, int, int]
CALLS = st.lists(
    st.one_of(
        st.tuples(st.just("bit"), st.integers(0, 1), st.integers(0, 3)),
        st.integers(0, 32).flatmap(
            lambda count: st.tuples(st.just("bits"), st.integers(0, 2**count - 1), st.just(count))
        ),
        st.integers(1, 2**20).flatmap(
            lambda end: st.tuples(st.just("below"), st.integers(0, end - 1), st.just(end))
        ),
    ),
    max_size=60,
)


def said(coder: BinaryCoder, calls: list[Call], blind: bool) -> list[int]:
    found = []
    for kind, value, number in calls:
        given = 0 if blind else value
        if kind == "bit":
            found.append(coder.bit(given, number, 0, number, 1))
        elif kind == "bits":
            found.append(coder.bits(given, number))
        else:
            found.append(coder.below(given, number, "place"))
    return found


@given(CALLS)
def test_what_comes_back(calls: list[Call]) -> None:
    encoder = Encoder()
    values = said(encoder, calls, blind=False)
    decoder = Decoder(encoder.finish())
    assert said(decoder, calls, blind=True) == values == [value for _, value, _ in calls]
    decoder.finish()


@pytest.mark.parametrize("chance", [0.5, 0.1, 0.02, 0.0])
def test_bits_cost_what_they_say(chance: float) -> None:
    generator = random.Random(0)
    bits = [int(generator.random() < chance) for _ in range(4000)]
    encoder = Encoder()
    for bit in bits:
        encoder.bit(bit, 0, 0, 0, 0)
    entropy = {0.5: 1.0, 0.1: 0.469, 0.02: 0.1414, 0.0: 0.0}[chance]
    assert len(encoder.finish()) * 8 < 4000 * entropy * 1.1 + 60


def test_carries_run_through_all_bytes() -> None:
    encoder = Encoder()
    values = [1] * 400 + [0, 1] * 50 + [1] * 400
    for value in values:
        encoder.bit(value, 0, 0, 0, 0)
    decoder = Decoder(encoder.finish())
    assert [decoder.bit(0, 0, 0, 0, 0) for _ in values] == values


def test_too_few_bytes() -> None:
    decoder = Decoder(b"abc")
    with pytest.raises(FormatError, match="field bytes"):
        decoder.bits(0, 32) and decoder.bits(0, 32)


def test_a_number_beyond_its_end() -> None:
    encoder = Encoder()
    encoder.bits(7, 3)
    with pytest.raises(FormatError, match="field place"):
        Decoder(encoder.finish()).below(0, 5, "place")
    with pytest.raises(FormatError, match="field place"):
        Encoder().below(0, 0, "place")
