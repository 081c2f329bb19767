"""`nisp batch` with a stub for the encoder; what it does below is in tests/catalogue."""

from __future__ import annotations

import json
import os
from pathlib import Path

import click
import pytest
from nispcodec_cli.batch import ENCODE_NAMES
from nispcodec_cli.batch import command as batch
from nispcodec_cli.encode import command as encode

from nispcodec.catalogue.lock import locked
from tests.catalogue.stubs import meshes, wild, with_stub
from tests.cli.conftest import done, nisp, refused

FAST = ("--jobs", 2, "--thumbnail", 0)


@pytest.fixture(autouse=True)
def stub(monkeypatch: pytest.MonkeyPatch) -> None:
    """A batch that is made without an encoder gets the stub."""
    with_stub(monkeypatch, wild)


def test_it_takes_what_encode_takes() -> None:
    own = {each.name for each in batch.params}
    asked = {each.name for each in encode.params if isinstance(each, click.Option)}
    elsewhere = {"engine", "threads", "force", "progress", "quiet", "as_json", "output"}
    assert asked - elsewhere == set(ENCODE_NAMES)
    assert set(ENCODE_NAMES) <= own


def test_a_folder_becomes_a_catalogue(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", "deep/b")
    result = done("batch", source, "-o", tmp_path / "out", *FAST, "--seed", 3)
    assert result.stdout.startswith("2 done, 0 failed, 0 not begun: ")
    out = tmp_path / "out"
    lines = [json.loads(line) for line in (out / "catalogue.jsonl").read_text().splitlines()]
    assert [(each["output"], each["options"]) for each in lines] == [
        ("a.nisp", {"seed": 3}),
        ("deep/b.nisp", {"seed": 3}),
    ]
    again = done("batch", source, "-o", out, *FAST, "--seed", 3, "--quiet")
    assert again.stdout.startswith("2 done (2 of an earlier run), 0 failed")
    assert again.stderr == ""


def test_failures_are_a_line_each_and_code_3(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", "refused")
    (source / "list.csv").write_text("source,seed\na.obj,none\n")
    inputs = (source, source / "list.csv", tmp_path / "gone.obj")
    result = nisp("batch", *inputs, "-o", tmp_path / "out", *FAST)
    assert result.exit_code == 3
    assert "1 done, 3 failed" in result.stdout
    said = [each for each in result.stderr.splitlines() if each.startswith("nisp: failed: ")]
    assert len(said) == 3
    assert f"{source / 'list.csv'} line 2: seed: expected int" in said[0]


def test_json_is_a_line_for_each_asset_and_the_end(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", "refused")
    result = nisp("batch", source, "-o", tmp_path / "out", *FAST, "--json")
    *assets, end = map(json.loads, result.stdout.splitlines())
    assert {each["output"]: (each["status"], each["kept"]) for each in assets} == {
        "a.nisp": ("done", False),
        "refused.nisp": ("failed", False),
    }
    assert end["end"]["total"] == 2
    assert end["end"]["failed"] == 1


def test_paths_come_on_standard_input(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a", os.fsdecode(b"caf\xe9"))
    listed = f"{source}/".encode() + b"caf\xe9.obj\n"
    result = done("batch", "-", "-o", tmp_path / "out", *FAST, given=listed)
    assert "1 done" in result.stdout


def test_a_full_disk_says_what_to_do(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "full-a", "full-b", "full-c")
    result = nisp("batch", source, "-o", tmp_path / "out", "--jobs", 1, "--thumbnail", 0)
    assert result.exit_code == 3
    assert "0 done, 1 failed, 2 not begun" in result.stdout
    assert "make room and run it again" in result.stderr


def test_shards_and_their_merge(tmp_path: Path) -> None:
    source, out = meshes(tmp_path / "in", "a", "b", "c", "refused"), tmp_path / "out"
    nisp("batch", source, "-o", out, *FAST, "--shard", "1/2", "--metrics", tmp_path / "m.txt")
    refused(nisp("batch", "-o", out, "--shard", "3/2", source), "expected 1/N to N/N, found 3/2")
    refused(nisp("batch", "-o", out, "--shard", "x", source), "expected I/N such as 3/8, found 'x'")
    nisp("batch", source, "-o", out, *FAST, "--shard", "2/2")
    assert (tmp_path / "m.txt").read_text().endswith("# EOF\n")
    refused(nisp("batch", source, "-o", out, "--merge"), "expected no INPUT beside it")
    result = nisp("batch", "-o", out, "--merge")
    assert (result.exit_code, result.stdout) == (3, "3 done, 1 failed\n")
    assert (out / "catalogue.html").exists()
    refused(nisp("batch", "-o", out, "--merge"), "found none")


def test_mistakes_are_refused(tmp_path: Path) -> None:
    source = meshes(tmp_path / "in", "a")
    refused(nisp("batch", "-o", tmp_path / "out"), "INPUT: expected some, found none")
    refused(nisp("batch", source, "-o", source / "a.obj"), "found a file")
    refused(nisp("batch", source, "-o", tmp_path / "out", "--preset", "slow"), "expected one of")
    with locked(tmp_path / "out"):
        refused(nisp("batch", source, "-o", tmp_path / "out"), "expected no other nisp batch")
