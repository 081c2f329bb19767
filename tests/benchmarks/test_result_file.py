from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.measuring.result_file import commits_of, read_result, result_so_far, write_result


def test_a_result_comes_back_from_a_folder_that_was_not_there(tmp_path: Path) -> None:
    path = tmp_path / "results" / "some.json"
    write_result(path, {"commit": "abc", "assets": {"spot": {"bytes": 3}}})
    assert read_result(path) == result_so_far(path)
    assert read_result(path)["assets"]["spot"]["bytes"] == 3
    assert path.read_text().endswith("}\n")


def test_a_run_that_begins_has_nothing_so_far(tmp_path: Path) -> None:
    assert result_so_far(tmp_path / "none.json") == {}
    with pytest.raises(FileNotFoundError):
        read_result(tmp_path / "none.json")


def test_commits_are_found_however_deep() -> None:
    result = {"commit": "a", "assets": {"spot": {"commit": "b"}}, "runs": [{"commit": "b"}, 3]}
    assert sorted(commits_of(result)) == ["a", "b", "b"]
