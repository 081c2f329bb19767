"""The `info` field: short on disk, the same again to the digits that a measurement has."""

from __future__ import annotations

import pytest

from nispcodec.core.errors import FormatError
from nispcodec.encode import config
from nispcodec.format import canonical, measures
from nispcodec.format.constants import PRESETS

ENCODERS: dict[str, measures.Scalar] = {
    "preset": "balanced",
    "seed": 7,
    "hidden_share": 0.0129,
    "open_surface_share": 0.0,
    "distance_error": 4.25e-4,
    "chart_accuracy": 1.0,
    "uv_error_median": 2.47e-4,
    "uv_error_mean": 3.34e-6,
}


def test_presets_are_the_encoders() -> None:
    # In another order: the format's are numbers on disk.
    assert set(PRESETS) == set(config.PRESETS)


def test_what_an_encoder_writes() -> None:
    stored = measures.encode(ENCODERS)
    assert (stored[1], stored[3]) == (1, 12_900)
    assert measures.decode(stored) == ENCODERS
    assert len(canonical.encode("META", stored)) <= 32


@pytest.mark.parametrize("value", [True, False, 0, -1, 2**64 - 1, "", 0.1, -4e-9, 1e300, 1e30])
def test_what_others_write(value: str | float) -> None:
    back = measures.decode(measures.encode({"other": value}))["other"]
    assert (back, type(back)) == (value, type(value))


@pytest.mark.parametrize("value", [1e30, -0.5, 123.456789, 1e-12])
def test_known_names_with_odd_values(value: float) -> None:
    back = measures.decode(measures.encode({"uv_error_mean": value}))["uv_error_mean"]
    assert back == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize("preset", [*PRESETS, "somebody else's"])
def test_presets(preset: str) -> None:
    assert measures.decode(measures.encode({"preset": preset})) == {"preset": preset}


@pytest.mark.parametrize("preset", [0, 1, True])
def test_a_preset_is_text(preset: int) -> None:
    with pytest.raises(FormatError, match=r"preset: expected text"):
        measures.encode({"preset": preset})


@pytest.mark.parametrize("key", [0, 12, -1, True, "seed", 1.5, b"seed"])
def test_keys_that_mean_nothing(key: object) -> None:
    with pytest.raises(FormatError, match=r"document\.info"):
        measures.decode({key: 1})
