from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType

import pytest

pytest.importorskip("DracoPy", reason="peers: extra `bench`")

from benchmarks.headline import duel, main_job, pictures
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from benchmarks.paper import pictures as paper_pictures
from benchmarks.rate_distortion import command
from benchmarks.studies import decoder, format, mesh_queries, rounding_loss

RECORD = {"bytes": 50, "charts": {"accuracy": 0.98}}


def test_a_target_is_met_missed_or_not_measured() -> None:
    accuracy = Target("accuracy", ("charts", "accuracy"), 0.97, at_least=True)
    places = [("bytes",), ("charts", "accuracy"), ("seconds",)]
    found = [Asked("spot", Target("", place, 40), RECORD).verdict for place in places]
    assert found == ["missed", "met", "not measured"]
    assert Asked("spot", accuracy, RECORD).verdict == "met"
    assert Asked("spot", Target("", ("rate",), 0), {"rate": None}).verdict == "not measured"


def test_a_line_says_what_was_asked_and_what_came() -> None:
    lines = [Asked("spot", Target("size", (name,), 40), RECORD).line() for name in ("bytes", "s")]
    assert lines[0].split() == ["spot", "size", "<=", "40", "50", "MISSED"]
    assert lines[1].split() == ["spot", "size", "<=", "40", "not", "measured"]


def test_every_record_is_asked_for_its_own_targets() -> None:
    def targets(name: str) -> Iterator[Target]:
        yield Target("size", ("bytes",), 40 if name == "spot" else 60)

    found = asked_of_each({"spot": RECORD, "boombox": RECORD}, targets)
    assert [(each.name, each.verdict) for each in found] == [("spot", "missed"), ("boombox", "met")]


RESULTS: list[tuple[ModuleType, Record, int]] = [
    (main_job, {"assets": {"boombox": {}}}, 7),
    (pictures, {"assets": {"boombox": {}}}, 2),
    (duel, {"means": {}}, 5),
    (command, {"summary": {}}, 1),
    (decoder, {"queries_8x64": {"plain": {}}, "assets": {"boombox": {}}}, 3 + 14),
    (format, {"files": {"10 kB": {"materials": 1}, "two": {"materials": 2}}}, 3),
    (rounding_loss, {"assets": {"spot": {}}}, 3),
    (mesh_queries, {"points": {"in the cube": {}}}, 1),
    (paper_pictures, {"assets": {"spot": {"charts": 2}, "plain": {"charts": 1}}}, 2),
]


@pytest.mark.parametrize(("module", "results", "count"), RESULTS)
def test_a_command_tells_what_is_asked_of_its_results(
    module: ModuleType, results: Record, count: int
) -> None:
    found = list(module.asked(results))
    assert [each.verdict for each in found] == ["not measured"] * count
