"""The curve of an asset, from made-up points: what of the default's distance is left, and asked."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("matplotlib", reason="plots: extra `bench`")

from benchmarks.studies.curve import asked, compared, results_of, rival_distance

RIVALS: Any = [{"bytes": 1000, "distance": 1e-3}, {"bytes": 4000, "distance": 2.5e-4}]
DEFAULT = {
    "bytes": {"geometry_uv": 1000},
    "metrics": {
        "geometry": {"larger": {"mean": 5e-4}},
        "uv": {"larger": {"mean": 2e-3, "median": 3e-4}},
    },
}


def found(distance: float, bytes_of_asked: float = 0.99) -> dict[str, Any]:
    return {"distance": distance, "bytes_of_asked": bytes_of_asked}


def test_the_rivals_front_is_straight_in_logarithms() -> None:
    assert rival_distance(RIVALS, 2000) == pytest.approx(5e-4)
    assert rival_distance(RIVALS, 500) == pytest.approx(1e-3)
    assert rival_distance(RIVALS, 9000) == pytest.approx(2.5e-4)


def test_distances_are_shares_of_the_defaults_and_of_the_rivals() -> None:
    curve = compared(DEFAULT, {"2": found(2.5e-4), "4": {"failure": "no"}}, RIVALS)
    assert curve["fall"] == pytest.approx({"2": 0.5})
    assert curve["of_rival"] == pytest.approx({"2": 0.5})
    assert curve["rival_fall"]["4"] == pytest.approx(0.25)


def test_what_is_asked_of_the_mean_and_of_each_asset() -> None:
    points = {"2": found(3e-4), "3": found(2e-4, 1.01), "4": found(1e-4)}
    results = results_of({"spot": compared(DEFAULT, points, RIVALS)})
    verdicts = {each.target.name: each.verdict for each in asked(results)}
    assert verdicts == {
        "distance / default's, 3 x, mean": "met",
        "bytes / asked, 2 x": "met",
        "bytes / asked, 3 x": "missed",
        "bytes / asked, 4 x": "met",
        "distance / default's, 2 x": "missed",
        "distance / default's, 4 x": "met",
    }
