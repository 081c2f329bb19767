"""How large networks are made: with what there is to learn, with the scale, within bounds."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.fit.sizes import (
    MAX_WIDTH,
    MIN_WIDTH,
    MODELS,
    bytes_of,
    even_width,
    scale_for_bytes,
    widths_for,
)
from nispcodec.network import NetworkSpec

ERRORS = {"sdf": 1e-3, "chart": 0.05, "uv": 3e-3}
errors = st.floats(1e-6, 1.0)
scales = st.floats(0.0, 10.0)


def test_each_network_has_a_width() -> None:
    assert set(widths_for(ERRORS, 5.0)) == set(MODELS)
    assert widths_for({"sdf": 1e-3}, 5.0) == {"sdf": widths_for(ERRORS, 5.0)["sdf"]}


@given(errors, errors, scales, scales)
def test_more_to_learn_or_a_larger_scale_is_never_narrower(
    one: float, other: float, small: float, large: float
) -> None:
    one, other, small, large = *sorted((one, other)), *sorted((small, large))
    for name in MODELS:
        narrow = widths_for({"sdf": one, name: one}, 2.0, small)[name]
        wide = widths_for({"sdf": other, name: other}, 3.0, large)[name]
        assert MIN_WIDTH <= narrow <= wide <= MAX_WIDTH


@given(st.floats(-10, 1000))
def test_widths_are_even(width: float) -> None:
    assert even_width(width) % 2 == 0


@pytest.mark.parametrize("wanted", [2000, 10_000, 50_000])
def test_the_scale_meets_the_bytes(wanted: float) -> None:
    def size(scale: float) -> float:
        widths = widths_for(ERRORS, 5.0, scale)
        return bytes_of({name: NetworkSpec((width,) * 4, 2) for name, width in widths.items()})

    scale = scale_for_bytes(size, wanted)
    assert size(scale) >= wanted > size(scale - 0.2)
