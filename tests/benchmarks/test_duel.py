"""The duel over several seeds."""

from __future__ import annotations

import pytest

from benchmarks.headline.duel import BETWEEN, Duel, over_seeds


def found(size: int, share: float | None, color: float) -> Duel:
    return {"bytes": size, "share": {BETWEEN: share}, "color_above": color}


def test_seeds_become_means_of_shares_geometric_and_say_how_far_they_went_apart() -> None:
    merged = over_seeds([found(400, 0.4, 1.0), found(901, 0.9, 3.0)])
    assert merged["bytes"] == 650
    assert merged["share"][BETWEEN] == pytest.approx(0.6)
    assert merged["color_above"] == 2.0
    assert merged["seeds"] == {"count": 2, "share": [0.4, 0.9], "color_above": [1.0, 3.0]}


def test_an_asset_without_a_share_in_one_seed_has_none() -> None:
    merged = over_seeds([found(400, 0.4, 1.0), found(900, None, 3.0)])
    assert merged["share"][BETWEEN] is None
    assert merged["seeds"]["share"] is None


def test_one_seed_stays_as_it_is() -> None:
    alone = found(400, 0.4, 1.0)
    merged = over_seeds([alone])
    assert merged["seeds"]["count"] == 1
    assert {**alone, "share": {BETWEEN: pytest.approx(0.4)}} == {
        name: merged[name] for name in alone
    }
