from __future__ import annotations

import math
from typing import Any

import pytest

from nispcodec.core.errors import NispError
from nispcodec.encode.config import PRESETS, EncodeConfig, Tuning
from nispcodec.geometry.config import MergingConfig


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"preset": "huge"}, "preset: expected one of .*paper, found 'huge'"),
        (
            {"texture_format": "gif"},
            "texture format: expected one of auto, webp, avif, jpeg, found 'gif'",
        ),
        ({"texture_quality": 0}, "texture quality: expected 1 to 100, found 0"),
        ({"texture_quality": 101}, "texture quality: expected 1 to 100, found 101"),
        ({"texture_quality": True}, "texture quality: expected a whole number, found True"),
        ({"seed": -1}, "seed: expected 0 or more, found -1"),
        ({"threads": 1.5}, "threads: expected a whole number, found 1.5"),
        ({"device": "gpu"}, "device: expected auto, cpu, cuda or cuda:N, found 'gpu'"),
        ({"device": "cuda:"}, "device: expected auto"),
        ({"target_size": 9e3, "target_error": 1e-3}, "expected one of them"),
        ({"preset": "paper", "target_size": 9e3}, "expected one of them"),
        ({"target_total": 9e4, "target_size": 9e3}, "expected one of them"),
        ({"target_total": -1.0}, "target size, total or error: expected more than 0, found -1"),
        ({"target_total": 9e4, "textures": False}, "target total: expected the textures"),
        ({"target_total": 9e4, "texture_format": "webp"}, "target total: expected the textures"),
        ({"target_error": 0.0}, "target size, total or error: expected more than 0, found 0"),
        ({"target_size": math.inf}, "target size, total or error: expected more than 0, found inf"),
        ({"target_size": math.nan}, "target size, total or error: expected more than 0, found nan"),
    ],
)
def test_choices_that_make_no_sense_are_refused(options: dict[str, Any], text: str) -> None:
    with pytest.raises(NispError, match=text):
        EncodeConfig(**options)


@pytest.mark.parametrize("device", ["auto", "cpu", "cuda", "cuda:1"])
@pytest.mark.parametrize("preset", PRESETS)
def test_choices_that_do(device: str, preset: str) -> None:
    assert EncodeConfig(preset, device=device, texture_quality=100).prunings() == {}


def test_a_short_fit_gets_fewer_samples() -> None:
    tuning = Tuning()
    fast, balanced = (tuning.sampling_of(preset) for preset in ("fast", "balanced"))
    assert fast.tight_count < balanced.tight_count == tuning.sampling.tight_count
    assert tuning.sampling_of("paper") == tuning.sampling


def test_only_the_paper_keeps_its_charts_apart() -> None:
    tuning = Tuning()
    assert tuning.geometry_of("paper").merging is None
    for preset in set(PRESETS) - {"paper"}:
        assert isinstance(tuning.geometry_of(preset).merging, MergingConfig)
