"""How large networks are made: with what there is to learn, with the scale, within bounds."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.network import NetworkSpec
from nispcodec.train.config import SizingConfig
from nispcodec.train.sizing import (
    bytes_of,
    even_width,
    foreseen,
    hidden_layers,
    scale_for_bytes,
)

CONFIG = SizingConfig()
ERRORS = {"sdf": 1e-3, "chart": 0.05, "uv": 3e-3}
errors = st.floats(1e-6, 1.0)
scales = st.floats(0.0, 10.0)


def test_each_network_has_layers_of_one_width() -> None:
    sizes = hidden_layers(ERRORS, 5.0)
    assert set(sizes) == set(CONFIG.models)
    assert all(len(hidden) == CONFIG.layers and len(set(hidden)) == 1 for hidden in sizes.values())
    assert hidden_layers({"sdf": 1e-3}, 5.0) == {"sdf": sizes["sdf"]}


@given(errors, errors, errors, scales, scales)
def test_more_to_learn_or_a_larger_scale_is_never_narrower(
    sdf: float, one: float, other: float, small: float, large: float
) -> None:
    one, other, small, large = *sorted((one, other)), *sorted((small, large))
    for name in CONFIG.models:
        narrow = hidden_layers({"sdf": sdf, name: one}, 2.0, small)[name]
        wide = hidden_layers({"sdf": sdf, name: other}, 3.0, large)[name]
        assert CONFIG.narrowest <= narrow[0] <= wide[0] <= CONFIG.widest
    least, most = (hidden_layers({"sdf": error}, 2.0, small)["sdf"] for error in (one, other))
    assert (len(least), *least) <= (len(most), *most)


def test_fine_detail_takes_deeper_networks() -> None:
    plain = hidden_layers(ERRORS, 5.0)
    fine = hidden_layers(ERRORS | {"sdf": 1.01 * CONFIG.fine}, 5.0)
    assert all(len(hidden) == CONFIG.fine_layers for hidden in fine.values())
    assert fine["sdf"] > plain["sdf"]


@given(st.floats(-10, 1000))
def test_widths_are_even(width: float) -> None:
    assert even_width(width) % 2 == 0


@pytest.mark.parametrize("wanted", [2000, 10_000, 50_000])
def test_the_scale_meets_the_bytes(wanted: float) -> None:
    def size(scale: float) -> float:
        sizes = hidden_layers(ERRORS, 5.0, scale)
        return bytes_of({name: NetworkSpec(hidden, 2) for name, hidden in sizes.items()})

    scale = scale_for_bytes(size, wanted)
    assert size(scale) >= wanted > size(scale - 0.2)


def test_a_wider_network_is_expected_to_end_nearer_than_its_probe() -> None:
    assert foreseen(1e-3, (24, 24, 24), (24,) * 4) == pytest.approx(1e-3)
    assert foreseen(1e-3, (24,) * 4, (48,) * 4) == pytest.approx(5e-4)
    assert foreseen(1e-3, (24,) * 4, (12,) * 4) == pytest.approx(2e-3)
