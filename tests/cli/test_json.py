"""`--json` on every command: one document on standard output, nothing else there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from nispcodec_cli import COMMANDS

from tests import tiny
from tests.catalogue.stubs import quick, with_stub
from tests.cli.conftest import done, nisp

CALLS: dict[str, tuple[object, ...]] = {
    "encode": ("ball.obj", "-o", "ball.nisp"),
    "batch": ("ball.obj", "-o", "catalogue", "--thumbnail", 0),
    "decode": ("tiny.nisp", "-o", "out.obj", "--resolution", 16),
    "render": ("tiny.nisp", "-o", "t.png", "--size", 16, "--turntable", 2),
    "sheet": ("ball.obj", "ball.obj", "-o", "s.png", "--size", 32),
    "view": ("tiny.nisp", "-o", "page.html"),
    "info": ("tiny.nisp",),
    "verify": ("tiny.nisp",),
    "recode": ("tiny.nisp", "-o", "re.nisp", "--no-textures"),
    "unpack": ("tiny.nisp", "-o", "images"),
    "retexture": ("tiny.nisp", "--slot", "base_color=ball_sphere.png", "-o", "new.nisp"),
    "compare": ("ball.obj", "ball.obj", "--samples", 200, "--explain"),
    "query": ("tiny.nisp", "points.csv", "-o", "answers.npz"),
    "sample": ("-o", "demo"),
}


# One object for each asset and one for the end: a million of them are no document.
STREAMED = ("batch",)


@pytest.fixture(autouse=True)
def folder(
    encoder: Any, model: Path, mesh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Path:
    """The working folder, with all that the CALLS read."""
    encoder(tiny.document())
    with_stub(monkeypatch, quick)
    (tmp_path / "ball_sphere.png").write_bytes(tiny.document().textures[0].data)
    (tmp_path / "points.csv").write_text("1,2,3\n2,2,3\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told(command: str, *options: object) -> dict[str, Any]:
    return json.loads(done(command, *CALLS[command], "--json", *options).stdout)


def test_every_command_is_called_here() -> None:
    assert set(CALLS) == set(COMMANDS)


@pytest.mark.parametrize("command", [each for each in COMMANDS if each not in STREAMED])
def test_the_output_is_one_json_object_and_nothing_else(command: str) -> None:
    assert isinstance(told(command), dict)


@pytest.mark.parametrize("command", STREAMED)
def test_the_output_is_a_json_object_a_line(command: str) -> None:
    lines = done(command, *CALLS[command], "--json").stdout.splitlines()
    assert all(isinstance(json.loads(line), dict) for line in lines)
    assert len(lines) == 2


@pytest.mark.parametrize("command", COMMANDS)
def test_without_json_people_read_words(command: str) -> None:
    text = done(command, *CALLS[command]).stdout
    assert text
    with pytest.raises(json.JSONDecodeError):
        json.loads(text)


@pytest.mark.parametrize("command", ["decode", "render", "unpack", "sample"])
def test_every_file_is_named_with_its_bytes(folder: Path, command: str) -> None:
    before = set(folder.rglob("*"))
    files = told(command)["files"]
    new = {path for path in folder.rglob("*") if path.is_file()} - before
    assert {folder / each["file"]: each["bytes"] for each in files} == {
        path: path.stat().st_size for path in new
    }


@pytest.mark.parametrize("command", ["encode", "decode", "sheet", "recode", "retexture", "query"])
def test_the_file_is_named(folder: Path, command: str) -> None:
    assert (folder / told(command)["file"]).stat().st_size > 0


@pytest.mark.parametrize("command", ["encode", "recode", "retexture"])
def test_bytes_of_a_nisp_are_split(folder: Path, command: str) -> None:
    report = told(command)
    parts = report["bytes"]
    assert parts["total"] == (folder / report["file"]).stat().st_size
    assert parts["total"] == parts["geometry_uv"] + parts["textures"]


def test_a_decode_says_faces_and_seconds() -> None:
    report = told("decode", "--faces", 50)
    assert 4 <= report["faces"] <= 50
    assert report["vertices"] > 0
    assert report["seconds"] >= 0


def test_a_query_says_how_many_points() -> None:
    assert told("query")["points"] == 2


def test_warnings_go_to_standard_error(folder: Path) -> None:
    for image in folder.glob("*.png"):
        image.unlink()
    result = done("encode", *CALLS["encode"], "--json")
    assert json.loads(result.stdout)["warnings"]
    assert "nisp: warning: " in result.stderr


def test_no_textures_is_a_warning_beside_the_json(folder: Path) -> None:
    done("recode", *CALLS["recode"])
    result = done("unpack", "re.nisp", "-o", "none", "--json")
    assert json.loads(result.stdout) == {"files": []}
    assert "nisp: warning: re.nisp holds no textures" in result.stderr


@pytest.mark.parametrize("command", ["decode", "info", "recode", "query"])
def test_errors_leave_standard_output_empty(folder: Path, command: str) -> None:
    (folder / "tiny.nisp").write_bytes(b"no model")
    result = nisp(command, *CALLS[command], "--json")
    assert (result.exit_code, result.stdout) == (2, "")


def test_a_fault_is_told_as_json(folder: Path) -> None:
    (folder / "tiny.nisp").write_bytes(b"this is no model at all")
    result = nisp("verify", "tiny.nisp", "--json")
    assert result.exit_code == 1
    report = json.loads(result.stdout)
    assert not report["sound"]
    assert report["problems"][0]["field"] == "signature"
