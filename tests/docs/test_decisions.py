"""The decision records: numbered, dated, in one form, and their index fresh."""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import sys
from datetime import date
from pathlib import Path
from types import ModuleType

import pytest

FOLDER = Path(__file__).parents[2] / "docs" / "decisions"
PATHS = sorted(FOLDER.glob("[0-9]*.md"))
HEADINGS = ["Question and expectation", "What was changed", "What came", "Decision"]
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
SUPERSEDED = re.compile(r"superseded by \[(\d{4})\]\((\1-[a-z0-9-]+\.md)\)")


def _index() -> ModuleType:
    spec = importlib.util.spec_from_file_location("decision_index", FOLDER / "index.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


INDEX = _index()
RECORDS = {path: INDEX.record_of(path) for path in PATHS}
TEXTS = {path: path.read_text(encoding="utf-8") for path in [*PATHS, FOLDER / "README.md"]}
REVERSED = {
    path: match[2] for path in PATHS if (match := SUPERSEDED.fullmatch(RECORDS[path].status))
}


def links(path: Path) -> list[str]:
    return LINK.findall(TEXTS[path])


def headings(path: Path) -> list[str]:
    return [line[3:] for line in TEXTS[path].splitlines() if line.startswith("## ")]


def run_index(folder: Path, *arguments: str) -> int:
    command = [sys.executable, str(folder / "index.py"), *arguments]
    return subprocess.run(command, capture_output=True, check=False).returncode


def test_numbers_have_no_gaps_and_no_doubles() -> None:
    assert [RECORDS[path].number for path in PATHS] == list(range(1, len(PATHS) + 1))


def test_file_names_start_with_the_number() -> None:
    form = re.compile(r"-[a-z0-9]+(-[a-z0-9]+)*\.md")
    assert [path for path in PATHS if int(path.name[:4]) != RECORDS[path].number] == []
    assert [path for path in PATHS if not form.fullmatch(path.name[4:])] == []


def test_every_record_has_a_date() -> None:
    dates = [RECORDS[path].date for path in PATHS]
    assert [date.fromisoformat(text).isoformat() for text in dates] == dates


def test_every_status_is_of_the_allowed_kinds() -> None:
    plain = {"kept", "dropped", "measured"}
    others = [path for path in PATHS if RECORDS[path].status not in plain]
    assert others == list(REVERSED)


def test_every_record_says_what_it_applies_to() -> None:
    form = re.compile(r"- Applies to: \S.*")
    assert [path for path in PATHS if not form.fullmatch(TEXTS[path].splitlines()[4])] == []


def test_every_record_has_the_headings_and_text_below_each() -> None:
    assert [path for path in PATHS if headings(path) != HEADINGS] == []
    parts = {path: re.split(r"^## .*$", TEXTS[path], flags=re.M) for path in PATHS}
    assert [path for path in PATHS if not all(part.strip() for part in parts[path])] == []


def test_links_resolve() -> None:
    assert [
        (path.name, link) for path in TEXTS for link in links(path) if not (FOLDER / link).is_file()
    ] == []


def test_a_reversed_decision_is_linked_both_ways() -> None:
    assert [path for path, name in REVERSED.items() if path.name not in links(FOLDER / name)] == []


def test_records_name_nothing_that_is_not_in_the_repository() -> None:
    outside = re.compile(r"\bissues?\b|\bsessions?\b|\.\./|\btoday\b", re.I)
    assert [
        (path.name, outside.findall(TEXTS[path])) for path in PATHS if outside.search(TEXTS[path])
    ] == []


def test_the_index_is_fresh() -> None:
    assert run_index(FOLDER, "--check") == 0


def test_a_stale_index_is_noticed_and_rewritten(tmp_path: Path) -> None:
    for name in ("index.py", "README.md", PATHS[0].name):
        shutil.copy(FOLDER / name, tmp_path)
    assert run_index(tmp_path, "--check") == 1
    assert run_index(tmp_path) == 0
    assert run_index(tmp_path, "--check") == 0


def test_a_record_without_a_head_is_an_error_that_names_the_line(tmp_path: Path) -> None:
    path = tmp_path / "0001-no-head.md"
    path.write_text("# 0001: A title\n\n- Date: 2026-11-22\n", encoding="utf-8")
    with pytest.raises(ValueError, match=r"0001-no-head\.md:4: expected"):
        INDEX.record_of(path)
