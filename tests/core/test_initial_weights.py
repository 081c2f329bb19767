"""Draws: SplitMix64 to the bit, any slice alike, and what they tell of symbols."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.initial_weights import BITS, initial_integers, predicted

numbers = st.integers(0, 2**32 - 1)


def test_they_are_those_of_splitmix64() -> None:
    """The generator's published first outputs from a state of 0."""
    published = [0xE220A8397B1DCDAF, 0x6E789E6AA1B965F4, 0x06C45D188009454F, 0xF88BB8A8724C81EC]
    assert initial_integers(0, 0, 4).tolist() == [(each >> 40) - 2**23 for each in published]


@given(numbers, st.integers(0, 500), st.integers(0, 500))
def test_any_slice_is_a_slice(number: int, first: int, count: int) -> None:
    np.testing.assert_array_equal(
        initial_integers(number, first, count), initial_integers(number, 0, 1000)[first:][:count]
    )


@given(numbers)
def test_they_spread_evenly(number: int) -> None:
    shares = initial_integers(number, 0, 4096) / (1 << BITS)
    assert shares.min() >= -1
    assert shares.max() < 1
    assert abs(shares.mean()) < 0.06
    assert abs(shares.var() - 1 / 3) < 0.03


def test_numbers_give_other_draws() -> None:
    assert len({tuple(initial_integers(number, 0, 3)) for number in range(1000)}) == 1000


@given(numbers, st.integers(0, 2**23 - 1))
def test_what_they_tell_is_the_share_of_the_reach(number: int, reach: int) -> None:
    drawn = initial_integers(number, 0, 50)
    for row_shift in range(8):
        found = predicted(drawn, reach, np.array([row_shift])) << row_shift
        assert np.abs(found - reach * (drawn / (1 << BITS))).max() <= 0.5 * 2**row_shift
