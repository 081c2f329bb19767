from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from nispcodec_cli import COMMANDS
from nispcodec_cli import main as group

from nispcodec.io.load import load_mesh
from nispcodec.io.save import SUFFIXES
from nispcodec.model import NispModel
from tests import tiny
from tests.cli.conftest import nisp, refused


def test_help_lists_every_command_and_imports_nothing_heavy() -> None:
    code = (
        "import sys; from click.testing import CliRunner; from nispcodec_cli import main;"
        "result = CliRunner().invoke(main, ['--help']); assert result.exit_code == 0;"
        "print(sorted({'numpy', 'torch', 'rich', 'nispcodec'} & set(sys.modules)));"
        "print(result.output)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy, text = done.stdout.split("\n", 1)
    assert heavy == "[]"
    assert all(command in text for command in COMMANDS)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command: str) -> None:
    result = nisp(command, "--help")
    assert result.exit_code == 0
    assert f"Example: nisp {command}" in result.output


def test_unknown_command() -> None:
    refused(nisp("explode"), "explode")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_decode_writes_a_mesh(model: Path, tmp_path: Path, suffix: str) -> None:
    out = tmp_path / f"out{suffix}"
    result = nisp("decode", model, "--mesh", "-o", out, "--resolution", 24)
    assert result.exit_code == 0, result.output
    assert out.stat().st_size > 0
    assert str(out) in result.stdout


@pytest.mark.parametrize("kept", [0, 5, 30])
@pytest.mark.parametrize("command", ["decode", "info", "query"])
def test_broken_model_is_refused(model: Path, tmp_path: Path, command: str, kept: int) -> None:
    model.write_bytes(model.read_bytes()[:kept])
    points = tmp_path / "p.npy"
    np.save(points, np.zeros((1, 3)))
    out = {"decode": ("-o", tmp_path / "o.glb"), "query": (points, "-o", tmp_path / "o.npz")}
    refused(nisp(command, model, *out.get(command, ())), str(model))
    assert not list(tmp_path.glob("o.*"))


@pytest.mark.parametrize("command", ["decode", "info"])
def test_missing_model_is_named(tmp_path: Path, command: str) -> None:
    out = ("-o", tmp_path / "out.glb") if command == "decode" else ()
    refused(nisp(command, tmp_path / "absent.nisp", *out), "absent.nisp")


def test_output_folder_must_exist(model: Path, tmp_path: Path) -> None:
    refused(nisp("decode", model, "-o", tmp_path / "nowhere" / "out.glb"), "nowhere")


def test_unknown_output_suffix(model: Path, tmp_path: Path) -> None:
    refused(nisp("decode", model, "-o", tmp_path / "out.fbx"), ".fbx", ".glb")


def test_info_json(model: Path) -> None:
    result = nisp("info", model, "--json")
    facts = json.loads(result.stdout)
    assert facts["bytes"]["total"] == model.stat().st_size
    assert facts["bytes"]["geometry_uv"] + facts["bytes"]["textures"] == model.stat().st_size
    assert set(facts["networks"]) == {"sdf", "chart", "uv"}
    assert facts["networks"]["sdf"]["weights"] == tiny.octahedron().spec.weight_count
    assert facts["charts"] == 2
    assert [each["name"] for each in facts["materials"]] == ["painted", "plain"]


def test_info_for_people(model: Path) -> None:
    result = nisp("info", model)
    assert result.exit_code == 0
    for word in ("geometry_uv", "painted", "tiny.png", "sdf"):
        assert word in result.stdout


def test_compare_a_mesh_with_itself(mesh: Path) -> None:
    report = json.loads(nisp("compare", mesh, mesh, "--samples", 500, "--json").stdout)
    assert report["geometry"]["larger"]["max"] < 1e-9
    assert report["uv"]["larger"]["p99"] < 1e-6


def test_compare_decoded_mesh_with_its_model(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.glb"
    nisp("decode", model, "-o", out, "--resolution", 48)
    result = nisp("compare", out, model, "--resolution", 48, "--samples", 500, "--json")
    report = json.loads(result.stdout)
    assert report["geometry"]["larger"]["mean"] < 1e-6
    assert report["charts"]["accuracy"] > 0.95


def test_compare_for_people(mesh: Path) -> None:
    result = nisp("compare", mesh, mesh, "--samples", 500)
    assert result.exit_code == 0
    assert "d1_psnr" in result.stdout


def test_compare_names_the_unreadable_mesh(mesh: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0\n")
    refused(nisp("compare", mesh, broken), "broken.obj")


def test_compare_tells_of_another_unit(mesh: Path, tmp_path: Path) -> None:
    asset, larger = load_mesh(mesh), tmp_path / "millimeters.obj"
    replace(asset, positions=1000 * asset.positions).save(larger)
    told = nisp("compare", mesh, larger, "--samples", 500)
    assert "millimeters.obj: 1000 times as large as the original" in told.stderr
    assert "times as large" not in nisp("compare", mesh, mesh, "--samples", 500).stderr


POINTS = np.array([[1.0, 2.0, 3.0], [2.5, 2.0, 3.0]])


@pytest.mark.parametrize("frame", ["world", "normalized"])
def test_query_npz(model: Path, tmp_path: Path, frame: str) -> None:
    np.save(tmp_path / "p.npy", POINTS)
    out = tmp_path / "out.npz"
    result = nisp("query", model, tmp_path / "p.npy", "-o", out, "--frame", frame)
    assert result.exit_code == 0, result.output
    expected = NispModel(tiny.document())
    with np.load(out) as answers:
        np.testing.assert_array_equal(answers["sdf"], expected.sdf(POINTS, frame))
        np.testing.assert_array_equal(answers["chart"], expected.charts(POINTS, frame))
        np.testing.assert_array_equal(answers["uv"], expected.uv(POINTS, frame))
        np.testing.assert_array_equal(answers["color"], expected.color(POINTS, frame))


@pytest.mark.parametrize("header", ["", "x,y,z\n"])
def test_query_csv_in_and_out(model: Path, tmp_path: Path, header: str) -> None:
    (tmp_path / "p.csv").write_text(header + "1,2,3\n2.5, 2, 3\n")
    out = tmp_path / "out.csv"
    assert nisp("query", model, tmp_path / "p.csv", "-o", out).exit_code == 0
    rows = np.genfromtxt(out, delimiter=",", names=True)
    np.testing.assert_allclose(rows["x"], POINTS[:, 0])
    np.testing.assert_allclose(rows["sdf"], NispModel(tiny.document()).sdf(POINTS), rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("p.csv", b"1,2\n"),
        ("p.csv", b"1,2,3\n4,5\n"),
        ("p.csv", b"1,2,three\n"),
        ("p.csv", b"1,2,nan\n"),
        ("p.csv", b""),
        ("p.csv", b"\xff\xfe"),
        ("p.npy", b""),
        ("p.npy", b"\x93NUMPY\x01\x00garbage"),
        ("p.txt", b"1,2,3\n"),
    ],
)
def test_query_refuses_bad_points(model: Path, tmp_path: Path, name: str, content: bytes) -> None:
    points = tmp_path / name
    points.write_bytes(content)
    refused(nisp("query", model, points, "-o", tmp_path / "out.npz"))
    assert not (tmp_path / "out.npz").exists()


def test_query_never_unpickles(model: Path, tmp_path: Path) -> None:
    np.save(tmp_path / "p.npy", np.array([{"a": 1}], dtype=object), allow_pickle=True)
    refused(nisp("query", model, tmp_path / "p.npy", "-o", tmp_path / "out.npz"), "p.npy")


def test_sample_can_be_loaded(tmp_path: Path) -> None:
    result = nisp("sample", "-o", tmp_path / "deep" / "demo")
    assert result.exit_code == 0, result.output
    mesh = load_mesh(tmp_path / "deep" / "demo" / "sample.obj")
    assert len(mesh.materials) >= 2
    assert not mesh.warnings


def test_errors_of_the_program_itself_are_not_hidden(
    monkeypatch: pytest.MonkeyPatch, model: Path
) -> None:
    def broken(*_: object) -> None:
        raise AssertionError("a bug")

    monkeypatch.setattr("nispcodec.format.unpack", broken)
    with pytest.raises(AssertionError):
        CliRunner().invoke(group, ["info", str(model)], catch_exceptions=False)


PEAK = r"""
import re, sys
from nispcodec_cli import main
try:
    main(["query", *sys.argv[1:]])
finally:
    print(re.search(r"VmHWM:\s+(\d+)", open("/proc/self/status").read())[1])
"""


def query_peak(model: Path, folder: Path, points: int) -> int:
    """Bytes that a query takes, with its program and without its input.

    That is mapped, so the system takes it back when it likes. What getrusage says begins with the
    memory of the caller.
    """
    asked = np.zeros((points, 3))
    np.save(folder / "p.npy", asked)
    command = [sys.executable, "-c", PEAK, model, folder / "p.npy", "-o", folder / "o.npz"]
    run = subprocess.run([*map(str, command), "--force"], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return int(run.stdout.split()[-1]) * 1024 - asked.nbytes


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="peaks are told in other units elsewhere")
def test_ten_million_queries_fit_into_a_gigabyte(model: Path, tmp_path: Path) -> None:
    few, many = (query_peak(model, tmp_path, points) for points in (10, 3_000_000))
    assert few + (many - few) * 10 / 3 < 1e9


def test_csv_of_several_parts(model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("nispcodec_cli.query.PART", 2)
    (tmp_path / "p.csv").write_text("x,y,z\n" + "1,2,3\n\n2.5,2,3\n" * 3)
    assert nisp("query", model, tmp_path / "p.csv", "-o", tmp_path / "o.csv").exit_code == 0
    rows = np.genfromtxt(tmp_path / "o.csv", delimiter=",", names=True)
    np.testing.assert_allclose(rows["x"], [1, 2.5] * 3)
    expected = NispModel(tiny.document()).color(np.tile(POINTS, (3, 1)))
    np.testing.assert_allclose(rows["green"], expected[:, 1], rtol=1e-6)
