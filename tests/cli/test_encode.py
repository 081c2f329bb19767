from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from nispcodec_cli.parts import in_a_line, with_errors

from nispcodec.core.errors import FitError
from nispcodec.core.progress import Listener, Progress
from nispcodec.model import NispModel
from tests import tiny
from tests.cli.conftest import Encoder, nisp


def test_encode_writes_and_reports(encoder: Encoder, mesh: Path, tmp_path: Path) -> None:
    seen = encoder(tiny.document())
    out = tmp_path / "out.nisp"
    result = nisp("encode", mesh, "-o", out, "--seed", 7, "--no-textures", "--json")
    assert result.exit_code == 0, result.output
    report = json.loads(result.stdout)
    assert report["bytes"]["total"] == out.stat().st_size
    assert sum(report["input_bytes"].values()) == sum(
        each.stat().st_size for each in mesh.parent.iterdir() if each != out
    )
    assert report["input_bytes"]["textures"] > 0
    assert (seen["config"].seed, seen["config"].textures) == (7, False)
    assert "diverged at step 11" in result.stderr


def test_what_the_encode_warns_of_is_said_and_reported(
    monkeypatch: pytest.MonkeyPatch, mesh: Path, tmp_path: Path
) -> None:
    def encode(asset: object, config: object, progress: Listener) -> NispModel:
        progress(Progress(stage="samples", warning="mug: turned faces"))
        return NispModel(tiny.document())

    monkeypatch.setattr("nispcodec.encode", encode)
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--json", "--quiet")
    assert result.exit_code == 0, result.output
    assert "nisp: warning: mug: turned faces" in result.stderr
    assert json.loads(result.stdout)["warnings"][-1] == "mug: turned faces"


@pytest.mark.parametrize(
    ("options", "side", "said"),
    [
        ((), 200, True),
        ((), 2, False),
        (("--target-total", "90kB"), 200, False),
        (("--texture-format", "webp"), 200, False),
    ],
)
def test_textures_that_are_most_of_a_file_are_told_of(
    encoder: Encoder,
    mesh: Path,
    tmp_path: Path,
    options: tuple[str, ...],
    side: int,
    said: bool,
) -> None:
    noise = np.random.default_rng(0).integers(0, 256, (side, side, 3)).astype(np.uint8)
    encoder(replace(tiny.document(), textures=(tiny.png(noise),)))
    out = tmp_path / "out.nisp"
    result = nisp("encode", mesh, "-o", out, "--quiet", *options)
    assert result.exit_code == 0, result.output
    assert ("of the file: --texture-format auto" in result.stdout) is said


@pytest.mark.parametrize(
    ("rate", "expected"),
    [("0.3", 0.3), ("sdf=0.5,uv=.25", {"sdf": 0.5, "uv": 0.25}), ("chart=0", {"chart": 0.0})],
)
def test_pruning_is_asked_for(
    encoder: Encoder, mesh: Path, tmp_path: Path, rate: str, expected: object
) -> None:
    seen = encoder(tiny.document())
    options = ["--prune", "large_final", "--prune-rate", rate, "--prune-rounds", 3, "--quiet"]
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", *options)
    assert result.exit_code == 0, result.output
    config = seen["config"]
    assert (config.prune, config.prune_rate, config.prune_rounds) == ("large_final", expected, 3)


@pytest.mark.parametrize(
    ("rate", "said"),
    [
        ("80%", "expected 0.5 or sdf=0.5,chart=0.6,uv=0.4, found '80%'"),
        ("80", "prune rate of sdf: expected 0 to below 1, found 80"),
        ("sdf=0.5=0.6", "found 'sdf=0.5=0.6'"),
        ("uv=0.4,color=0.3", "expected sdf, chart, uv, found 'color'"),
    ],
)
def test_a_rate_that_makes_no_sense(
    encoder: Encoder, mesh: Path, tmp_path: Path, rate: str, said: str
) -> None:
    seen = encoder(tiny.document())
    out = tmp_path / "out.nisp"
    result = nisp("encode", mesh, "-o", out, "--prune", "smallest", "--prune-rate", rate)
    assert result.exit_code == 2
    assert said in result.stderr
    assert seen == {}


@pytest.mark.parametrize(
    ("given", "expected"),
    [("20000", 20000), ("20kB", 20000), ("1.5 KiB", 1536), (".5MB", 500_000)],
)
def test_a_target_size(
    encoder: Encoder, mesh: Path, tmp_path: Path, given: str, expected: int
) -> None:
    seen = encoder(tiny.document())
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--target-size", given)
    assert result.exit_code == 0, result.output
    assert seen["config"].target_size == expected


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--target-size", "small"], "expected a size such as 20000, 20kB or 20KiB, found 'small'"),
        (["--target-size", "1.2.3kB"], "found '1.2.3kB'"),
        (["--target-size", "-1"], "found '-1'"),
        (["--target-size", "0"], "expected more than 0"),
        (["--target-error", "nan"], "--target-error: expected a number above 0, found 'nan'"),
        (["--target-error", "1e-3", "--target-size", "9kB"], "expected one of them"),
        (["--target-error", "1e-3", "--preset", "paper"], "expected one of them"),
    ],
)
def test_targets_that_make_no_sense(
    encoder: Encoder, mesh: Path, tmp_path: Path, options: list[str], said: str
) -> None:
    seen = encoder(tiny.document())
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", *options)
    assert result.exit_code == 2
    assert said in result.stderr
    assert seen == {}


def test_a_rate_needs_a_strategy(encoder: Encoder, mesh: Path, tmp_path: Path) -> None:
    encoder(tiny.document())
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--prune-rate", "0.5")
    assert result.exit_code == 2
    assert "--prune-rate: expected --prune beside it" in result.stderr


def test_encode_report_for_people(encoder: Encoder, mesh: Path, tmp_path: Path) -> None:
    encoder(tiny.document())
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp")
    assert result.exit_code == 0, result.output
    assert "geometry_uv" in result.stdout


def test_quiet_is_quiet(encoder: Encoder, mesh: Path, tmp_path: Path) -> None:
    encoder(tiny.document())
    assert nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--quiet").stderr == ""


@pytest.mark.parametrize(
    ("outcome", "code", "said"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (FitError("sdf: diverged three times"), 2, "nisp: error: sdf: diverged three times"),
        (
            OSError(28, "No space left on device", "out.nisp"),
            2,
            "found: No space left",
        ),
    ],
)
def test_nothing_is_written_when_it_fails(
    encoder: Encoder, mesh: Path, tmp_path: Path, outcome: BaseException, code: int, said: str
) -> None:
    encoder(outcome)
    before = sorted(tmp_path.iterdir())
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--quiet")
    assert result.exit_code == code
    assert said in result.stderr
    assert sorted(tmp_path.iterdir()) == before


def test_bad_output_is_refused_before_any_work(
    encoder: Encoder, mesh: Path, tmp_path: Path
) -> None:
    seen = encoder(tiny.document())
    assert nisp("encode", mesh, "-o", tmp_path / "out.obj").exit_code == 2
    assert nisp("encode", mesh, "-o", tmp_path / "nowhere" / "out.nisp").exit_code == 2
    assert seen == {}


def refused_early(mesh: Path, out: Path, encoder: Encoder, *options: str) -> str:
    """What is said when nothing was fitted."""
    seen = encoder(tiny.document())
    result = nisp("encode", mesh, "-o", out, *options)
    assert result.exit_code == 2
    assert seen == {}
    return result.stderr


def test_too_many_materials_are_refused_before_any_work(encoder: Encoder, tmp_path: Path) -> None:
    names = "".join(f"usemtl m{number}\nf 1 2 3\n" for number in range(4097))
    path = tmp_path / "many.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + names)
    said = refused_early(path, tmp_path / "out.nisp", encoder)
    assert "materials: expected at most 4096, found 4097" in said


def test_a_full_disk_is_foreseen(
    encoder: Encoder, mesh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shutil.disk_usage", lambda _: SimpleNamespace(free=1000))
    said = refused_early(mesh, tmp_path / "out.nisp", encoder)
    assert "bytes free on the disk, found 1,000" in said


@pytest.mark.parametrize("content", ["", "v 0 0 0\n", "v 0 0 nan\nf 1 1 1\n", "f 1 2 3\n"])
def test_bad_mesh_is_named_and_nothing_written(
    encoder: Encoder, tmp_path: Path, content: str
) -> None:
    encoder(tiny.document())
    (tmp_path / "bad.obj").write_text(content)
    result = nisp("encode", tmp_path / "bad.obj", "-o", tmp_path / "out.nisp")
    assert result.exit_code == 2
    assert result.stderr.startswith("nisp: error: ")
    assert "bad.obj" in result.stderr
    assert not (tmp_path / "out.nisp").exists()


def test_missing_texture_is_a_warning(encoder: Encoder, mesh: Path, tmp_path: Path) -> None:
    encoder(tiny.document())
    next(tmp_path.glob("*.png")).unlink()
    result = nisp("encode", mesh, "-o", tmp_path / "out.nisp", "--quiet")
    assert result.exit_code == 0
    assert "nisp: warning: " in result.stderr


def test_the_report_says_of_every_part_why_it_is_one_and_what_it_is_off() -> None:
    parts = [{"name": "field", "bytes": 4321, "why": "dense and smooth bodies"}, {"name": "mesh 1"}]
    first, second = with_errors(parts, [(7.1849e-4, 0.02331), (float("nan"), float("nan"))])
    assert in_a_line(first) == (
        "field: 4,321 bytes, 0.000718 off, UVs 0.0233; dense and smooth bodies"
    )
    assert second == {"name": "mesh 1"}
    assert with_errors(parts, []) == parts
