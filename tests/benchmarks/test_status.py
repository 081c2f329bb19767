from __future__ import annotations

import subprocess
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import pytest
from click.testing import CliRunner

pytest.importorskip("matplotlib", reason="plots: extra `bench`")

from benchmarks import status
from benchmarks.measuring.build import HERE
from benchmarks.measuring.history import commits_since, committed, date_of
from benchmarks.measuring.result_file import write_result
from benchmarks.report.committed import FORMER, RESULTS, UNMEASURED, CommittedResult

FOLLOWED = {path for result in RESULTS for path in result.depends}
Commit = Callable[[str], str]


@pytest.fixture
def commit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Commit:
    """A repository that stands for ours; commits a change of a file -> the commit."""
    monkeypatch.setattr(status, "HERE", tmp_path)
    who = ["-c", "user.name=nobody", "-c", "user.email=nobody@example.org"]

    def git(*words: str) -> str:
        command = ["git", "-C", str(tmp_path), *who, *words]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    def change(name: str) -> str:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a") as file:
            file.write("\n")
        git("add", ".")
        git("commit", "-qm", name)
        return git("rev-parse", "--short=12", "HEAD")

    git("init", "-q")
    return change


def test_every_committed_file_has_a_command_and_is_followed() -> None:
    known = {name for result in RESULTS for name in (result.file, *result.beside)}
    there = {path.name for path in (HERE / status.FOLDER).iterdir()}
    assert not there - known
    assert all(result.depends or result.made_from for result in RESULTS)
    assert all(find_spec(result.command) and find_spec(result.module) for result in RESULTS)


def test_what_results_follow_is_there_unless_it_was_renamed() -> None:
    plain = {path for path in FOLLOWED if not path.startswith(":")}
    assert {path for path in plain if not (HERE / path).exists()} <= set(FORMER)
    assert not [path for path in FORMER if (HERE / path).exists()]


def test_every_part_of_the_library_is_followed_or_said_not_to_be() -> None:
    parts = {f"nispcodec/{path.parent.name}" for path in HERE.glob("nispcodec/*/__init__.py")}
    assert parts <= FOLLOWED | set(UNMEASURED)
    assert not FOLLOWED & set(UNMEASURED)


@pytest.mark.parametrize("result", RESULTS, ids=lambda result: result.file)
def test_the_targets_of_every_result_can_be_read(result: CommittedResult) -> None:
    if not (HERE / status.FOLDER / result.file).exists():
        pytest.skip("not measured yet")
    assert not [line for line in status.unmet(result) if line[2].startswith("not read")]


def test_only_commits_that_touch_the_paths_count(tmp_path: Path, commit: Commit) -> None:
    first = commit("train/loop.py")
    for name in ("docs/words.md", "train/loop.py", "fit/loop.py"):
        commit(name)
    assert commits_since(tmp_path, first, ["train"]) == 1
    assert commits_since(tmp_path, f"{first}+changes", ["train", "fit", "gone"]) == 2
    assert commits_since(tmp_path, "0123456789ab", ["train"]) is None
    assert date_of(tmp_path, "0123456789ab") is None
    assert len(date_of(tmp_path, first) or "") == len("2026-01-01")
    assert committed(tmp_path, "docs") == ["words.md"]


def measure(place: Path, file: str, commits: list[str]) -> None:
    assets = {f"asset {index}": {"commit": each} for index, each in enumerate(commits)}
    write_result(place / status.FOLDER / file, {"assets": assets})


def test_a_result_is_as_old_as_its_oldest_record(
    tmp_path: Path, commit: Commit, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = commit("train/a"), commit("train/b")
    commit("train/c")
    results = (
        CommittedResult("some.json", "benchmarks.some", ("train",)),
        CommittedResult("lost.json", "benchmarks.lost", ("train",)),
        CommittedResult("made.json", "benchmarks.made", made_from=("some.json",)),
    )
    monkeypatch.setattr(status, "RESULTS", results)
    measure(tmp_path, "some.json", [old, new, new])
    measure(tmp_path, "lost.json", ["0123456789ab"])
    some, lost, made = map(status.age_row, results)
    assert some[:2] == ["some.json", "1 to 2"]
    assert some[2].startswith(f"{old} (")
    assert lost[1:3] == ["?", "0123456789ab (not in the history)"]
    assert made[1:3] == some[1:3]


def test_missed_targets_and_unread_ones_are_told(
    tmp_path: Path, commit: Commit, monkeypatch: pytest.MonkeyPatch
) -> None:
    duel = CommittedResult("duel.json", "benchmarks.headline.duel", ("train",))
    other = CommittedResult("other.json", "benchmarks.headline.main_job", ("train",))
    absent = CommittedResult("absent.json", "benchmarks.absent", ("train",))
    monkeypatch.setattr(status, "RESULTS", (duel, other, absent))
    folder = tmp_path / status.FOLDER
    means = {"between settings": {"four": 0.4, "all": 0.4, "worst": 1.0}}
    color = {"mean": 2.5, "worst": 0.5}
    write_result(folder / "duel.json", {"means": means, "color": color, "commit": "abc"})
    write_result(folder / "other.json", {"commit": "abc"})
    write_result(folder / "stranger.json", {})
    commit("train/a")
    done = CliRunner().invoke(status.main, ["--markdown"])
    assert done.exit_code == 0
    assert "| duel.json | all assets | bytes, ours / theirs, four | <= 0.38 | 0.4 |" in done.output
    assert "| duel.json | all assets | bytes, ours / theirs, all |" not in done.output
    assert "| other.json |  | not read: KeyError: 'assets' |  |  |" in done.output
    assert "Not measured yet: benchmarks.absent" in done.output
    assert "| asked for, measured by no command | asked |" in done.output
    assert "stranger.json" in done.output
    assert "| --- |" not in CliRunner().invoke(status.main).output


def test_without_git_it_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status, "HERE", tmp_path)
    done = CliRunner().invoke(status.main)
    assert (done.exit_code, done.output[:20]) == (0, "no committed results")
