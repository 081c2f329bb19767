"""Integers of any size, whatever was expected of them."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from nispcodec.format.mesh.binary_coder import Decoder, Encoder
from nispcodec.format.mesh.numbers import LONGEST, Context, signed

VALUES = st.integers(-(2**LONGEST) + 1, 2**LONGEST - 1)


@given(st.lists(st.tuples(VALUES, st.integers(0, LONGEST))))
def test_what_comes_back(values: list[tuple[int, int]]) -> None:
    encoder = Encoder()
    for value, expected in values:
        assert signed(encoder, value, 64, Context(expected, 1, 2)) == value
    decoder = Decoder(encoder.finish())
    assert [signed(decoder, 0, 64, Context(expected, 1, 2)) for _, expected in values] == [
        value for value, _ in values
    ]


def test_what_was_expected_takes_less() -> None:
    sizes = {}
    for expected in (0, 6):
        encoder = Encoder()
        for value in (40, -50, 33, -61, 45, 58):
            signed(encoder, value, 64, Context(expected))
        sizes[expected] = len(encoder.finish())
    assert sizes[6] < sizes[0]
