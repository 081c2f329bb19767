from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from benchmarks.headline import best
from benchmarks.measuring.build import Build

OLD = {"bytes": 6000, "seconds": 300.0, "errors": {"distance": 4e-4, "uv_median": 2e-4}}
NEW = {"bytes": 5900, "seconds": 60.0, "errors": {"distance": 3e-4, "uv_median": 3e-4}}


def test_means_are_asked_over_the_assets_of_both_builds() -> None:
    both = {"old": OLD, "new": NEW, "balanced_seconds": 120.0}
    verdicts = {
        each.target.name: each.verdict
        for each in best.asked({"assets": {"a": both, "b": {"old": OLD}}})
    }
    assert verdicts == {
        "distance, new / old": "met",
        "median UV error, new / old": "missed",
        "time / old time of `balanced`": "met",
    }
    assert not list(best.asked({"assets": {"b": {"old": OLD}}}))


def test_the_new_build_gets_the_bytes_of_the_old_one(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked: list[tuple[str, ...]] = []

    def measured(build: Build, source: Any, *settings: str) -> dict[str, Any]:
        asked.append((build.name, *settings))
        return OLD if build.name == "old" else NEW

    builds = {name: Build(name, (), {}) for name in ("old", "new")}
    monkeypatch.setattr(best, "measured", measured)
    monkeypatch.setattr(best, "Source", lambda path: None)
    best.work({"spot": tmp_path}, builds, tmp_path / "best.json", "old")
    best.work({"spot": tmp_path}, builds, tmp_path / "best.json", "both")
    assert asked == [("old",), ("new", "--target-size", "6000")]
