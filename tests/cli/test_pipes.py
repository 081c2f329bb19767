"""`-` is standard input for a .nisp and for points, and standard output for answers."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from nispcodec_cli import COMMANDS

from nispcodec.model import NispModel
from tests import tiny
from tests.cli.conftest import done, nisp, refused

POINTS = np.array([[1.0, 2.0, 3.0], [2.5, 2.0, 3.0]])
CSV = b"1,2,3\n2.5,2,3\n"


def rows(text: str) -> np.ndarray:
    return np.genfromtxt(text.splitlines(), delimiter=",", names=True)


@pytest.mark.parametrize(
    ("command", "rest", "name"),
    [
        ("info", (), None),
        ("info", ("--textures",), None),
        ("verify", (), None),
        ("decode", ("--resolution", 16), "out.glb"),
        ("render", ("--size", 16), "out.png"),
        ("recode", ("--coding", "dense"), "out.nisp"),
        ("unpack", (), "out"),
    ],
)
def test_a_model_from_standard_input(
    model: Path, tmp_path: Path, command: str, rest: tuple[object, ...], name: str | None
) -> None:
    out = ("-o", tmp_path / name, "--force") if name else ()
    piped = done(command, "-", *out, *rest, given=model.read_bytes())
    first = contents(tmp_path / name) if name else piped.stdout.replace("standard input", "NAME")
    named = done(command, model, *out, *rest)
    assert first == (
        contents(tmp_path / name) if name else named.stdout.replace(str(model), "NAME")
    )


def contents(path: Path) -> list[bytes]:
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    return [each.read_bytes() for each in files]


def test_what_comes_from_a_pipe_is_called_standard_input() -> None:
    refused(nisp("info", "-", given=b"v 0 0 0"), "nisp: error: standard input: this is no .nisp")
    refused(nisp("info", "-", given=b""), "standard input: this is no .nisp file", "empty")
    assert "standard input" in nisp("verify", "-", given=b"v 0 0 0").stdout


def test_points_from_a_pipe(model: Path, tmp_path: Path) -> None:
    done("query", model, "-", "-o", tmp_path / "a.csv", given=CSV)
    (tmp_path / "p.csv").write_bytes(CSV)
    done("query", model, tmp_path / "p.csv", "-o", tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_answers_to_a_pipe(model: Path) -> None:
    found = rows(done("query", model, "-", "-o", "-", given=CSV).stdout)
    np.testing.assert_allclose(found["sdf"], NispModel(tiny.document()).sdf(POINTS), rtol=1e-6)
    np.testing.assert_allclose(found["x"], POINTS[:, 0])


def test_answers_to_a_pipe_as_json(model: Path) -> None:
    result = done("query", model, "-", "-o", "-", "--json", "--frame", "normalized", given=CSV)
    found, expected = json.loads(result.stdout), NispModel(tiny.document())
    np.testing.assert_allclose(found["sdf"], expected.sdf(POINTS, "normalized"))
    assert found["chart"] == expected.charts(POINTS, "normalized").tolist()
    np.testing.assert_allclose(found["uv"], expected.uv(POINTS, "normalized"))
    np.testing.assert_allclose(found["color"], expected.color(POINTS, "normalized"))


def test_bad_points_from_a_pipe_are_named(model: Path) -> None:
    refused(
        nisp("query", model, "-", "-o", "-", given=b"1,2\n"), "standard input: expected numbers"
    )


def test_a_real_pipe(model: Path) -> None:
    command = [sys.executable, "-m", "nispcodec", "query", str(model), "-", "-o", "-"]
    run = subprocess.run(command, input=CSV, capture_output=True, check=True)
    assert len(rows(run.stdout.decode())) == 2
    assert run.stderr == b""


def test_a_reader_that_stops_early_is_no_traceback(model: Path) -> None:
    points = b"1,2,3\n" * 20_000
    command = f"{sys.executable} -m nispcodec query {model} - -o - | head -1"
    run = subprocess.run(command, shell=True, input=points, capture_output=True, check=True)
    assert run.stdout.startswith(b"x,y,z,sdf")
    assert run.stderr == b""


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_that_reads_a_pipe_says_so(command: str) -> None:
    reads = "MODEL" in done(command, "--help").stdout.splitlines()[0]
    assert ("- for standard input" in " ".join(done(command, "--help").stdout.split())) == reads
