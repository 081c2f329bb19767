"""Counts of samples: a share of those to learn from, all of those to be judged by."""

from __future__ import annotations

import pytest

from nispcodec.dataset.config import SamplingConfig


def test_a_share_leaves_spreads_and_what_networks_are_judged_by_alone() -> None:
    whole = SamplingConfig()
    half = whole.shared(0.5)
    changed = {name for name in vars(whole) if getattr(whole, name) != getattr(half, name)}
    assert half.tight_count == pytest.approx(whole.tight_count / 2)
    assert all(name.endswith("_count") for name in changed)
    assert not changed & {"held_out_count", "paper_count", "least_count"}
    assert whole.shared(1.0) == whole


def test_no_kind_of_samples_goes_away() -> None:
    assert min(SamplingConfig().shared(1e-9).__dict__[f"{k}_count"] for k in ("cube", "near")) == 1
