"""The options of `nisp decode`, each seen in the file that it writes."""

from __future__ import annotations

import json
import os
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import trimesh
from nispcodec_cli.decode import free_memory

from nispcodec.extract.config import ResolutionConfig
from nispcodec.io.load import load_mesh
from nispcodec.io.save import level_paths
from nispcodec.model import NispModel
from tests.cli.conftest import done, nisp, refused


def decoded(model: Path, out: Path, *options: object) -> Path:
    result = nisp("decode", model, "-o", out, *options)
    assert result.exit_code == 0, result.output
    return out


def test_faces(model: Path, tmp_path: Path) -> None:
    out = decoded(model, tmp_path / "out.glb", "--resolution", 48, "--faces", 500)
    assert 200 < len(load_mesh(out).faces) <= 500


def test_target_error(model: Path, tmp_path: Path) -> None:
    options = ("--resolution", 48, "--target-error")
    fine = load_mesh(decoded(model, tmp_path / "fine.glb", *options, 1e-6))
    coarse = load_mesh(decoded(model, tmp_path / "coarse.glb", *options, 1e-2))
    assert len(coarse.faces) < len(fine.faces)


def test_objects_have_the_name_of_the_file(model: Path, tmp_path: Path) -> None:
    out = decoded(model, tmp_path / "teapot.glb", "--resolution", 16)
    assert load_mesh(out).name == "teapot"
    data = out.read_bytes()
    assert data.count(b'"name":"teapot"') == 3  # scene, node, mesh
    decoded(model, tmp_path / "teapot.obj", "--resolution", 16)
    assert "o teapot\n" in (tmp_path / "teapot.obj").read_text()


def test_names_too_long_are_refused_before_the_work(model: Path, tmp_path: Path) -> None:
    longest = os.pathconf(tmp_path, "PC_NAME_MAX")
    # That of the mesh itself, and those of the files beside it.
    for suffix, more in ((".glb", 1), (".gltf", 0)):
        out = tmp_path / ("a" * (longest + more - len(suffix)) + suffix)
        refused(nisp("decode", model, "-o", out), "expected a shorter name, found 2")
    assert not list(tmp_path.glob("a*"))
    decoded(model, tmp_path / ("a" * (longest - 4) + ".stl"), "--resolution", 16)


def test_compress(model: Path, tmp_path: Path) -> None:
    plain = decoded(model, tmp_path / "plain.glb", "--resolution", 32)
    small = decoded(model, tmp_path / "small.glb", "--resolution", 32, "--compress", "quantize")
    assert small.stat().st_size < 0.7 * plain.stat().st_size
    assert len(load_mesh(small).faces) == len(load_mesh(plain).faces)
    other = nisp("decode", model, "-o", tmp_path / "out.obj", "--compress", "quantize")
    refused(other, "expected .glb")


def test_colors(model: Path, tmp_path: Path) -> None:
    out = decoded(model, tmp_path / "out.ply", "--resolution", 24, "--colors")
    visual = trimesh.load_mesh(out).visual
    assert isinstance(visual, trimesh.visual.ColorVisuals)
    assert len(np.unique(np.asarray(visual.vertex_colors), axis=0)) > 10


def test_rebake(model: Path, tmp_path: Path) -> None:
    pytest.importorskip("xatlas", reason="the extra `unwrap` is not installed")
    options = ("--resolution", 32, "--faces", 300, "--rebake", 64)
    mesh = load_mesh(decoded(model, tmp_path / "out.glb", *options))
    assert len(mesh.textures) == len(mesh.materials) == 1
    assert mesh.has_uv.all()
    assert mesh.uvs.min() >= 0
    assert mesh.uvs.max() <= 1


def test_lods(model: Path, tmp_path: Path) -> None:
    options = ("--resolution", 48, "--lods", 3, "--json")
    report = json.loads(done("decode", model, "-o", tmp_path / "out.glb", *options).stdout)
    names = ["out.glb", "out.lod1.glb", "out.lod2.glb"]
    assert sorted(path.name for path in tmp_path.glob("out*")) == names
    meshes = [load_mesh(tmp_path / name) for name in names]
    assert all(b'"name":"out"' in (tmp_path / name).read_bytes() for name in names)
    told = [report, *report["levels"]]
    assert [each["file"] for each in told] == [str(tmp_path / name) for name in names]
    assert [each["faces"] for each in told] == [len(mesh.faces) for mesh in meshes]
    again = nisp("decode", model, "-o", tmp_path / "out.lod1.glb", *options)
    refused(again, "expected no file of this name, found one")


@pytest.mark.parametrize("suffix", [".gltf", ".obj"])
def test_levels_share_images(model: Path, tmp_path: Path, suffix: str) -> None:
    out = tmp_path / f"out{suffix}"
    done("decode", model, "-o", out, "--resolution", 32, "--lods", 3)
    levels = [load_mesh(path) for path in level_paths(out, 3)]
    assert levels[0].textures
    assert all(each.textures == levels[0].textures for each in levels)
    # A level is a file and what it alone has: a buffer, or a library of materials.
    assert len(list(tmp_path.glob("out.*"))) == 6
    assert len(list(tmp_path.glob("out_*"))) == len(levels[0].textures)


def test_levels_that_are_no_coarser_are_told_once(model: Path, tmp_path: Path) -> None:
    options = ("--resolution", 16, "--lods", 8)
    told = done("decode", model, "-o", tmp_path / "out.glb", *options).stderr
    assert told.count("has no fewer triangles than out.lod") == 1
    few = done("decode", model, "-o", tmp_path / "few.glb", "--resolution", 48, "--lods", 2).stderr
    assert "no fewer" not in few


def test_contradictions_are_refused(model: Path, tmp_path: Path) -> None:
    for options in (
        ("--colors", "--rebake"),
        ("--lods", 2, "--rebake"),
        ("--faces", 2),
        ("--target-error", 0),
    ):
        refused(nisp("decode", model, "-o", tmp_path / "out.glb", *options), "expected", "found")
    assert not list(tmp_path.glob("out.*"))


def test_colors_that_a_format_cannot_hold_are_refused_before_the_work(
    model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(NispModel, "to_lods", None)
    result = nisp("decode", model, "-o", tmp_path / "out.stl", "--colors")
    refused(result, "STL holds no colors")


def test_it_says_what_the_format_cannot_hold(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.stl"
    result = done("decode", model, "-o", out, "--resolution", 24)
    assert f"nisp: warning: {out}: left out texture coordinates" in result.stderr
    colored = done("decode", model, "-o", tmp_path / "out.ply", "--resolution", 24, "--colors")
    assert "left out" not in colored.stderr


def test_it_says_bytes_seconds_faces_and_how_to_get_fewer(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.obj"
    result = done("decode", model, "-o", out, "--resolution", 24)
    assert f"{out}: {len(load_mesh(out).faces):,} faces in " in result.stdout
    assert " s\n" in result.stdout
    for path in (out, out.with_suffix(".mtl"), tmp_path / "out_tiny.png"):
        assert f"{path}: {path.stat().st_size:,} bytes" in result.stdout
    assert "--faces" in result.stdout
    assert "--target-error" in result.stdout


def test_who_asked_for_fewer_is_not_told_how(model: Path, tmp_path: Path) -> None:
    result = done("decode", model, "-o", tmp_path / "out.glb", "--resolution", 24, "--faces", 90)
    assert "--faces" not in result.stdout


def test_a_fine_grid_says_what_it_will_take(
    model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "nispcodec.extract.config.ResolutionConfig", partial(ResolutionConfig, most=30)
    )
    out = tmp_path / "a.ply"
    result = nisp("decode", model, "--resolution", "64", "-o", out, "--progress", "plain")
    assert result.exit_code == 0, result.output
    assert re.search(r"resolution 64: about [\d,]+ faces and 0\.0 GB of memory", result.stderr)
    result = nisp("decode", model, "--resolution", "30", "-o", out, "--force")
    assert "of memory" not in result.stderr


def test_a_grid_that_does_not_fit_into_memory_is_refused(
    model: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nispcodec_cli.decode.free_memory", lambda: 10**8)
    result = nisp("decode", model, "--resolution", "2048", "-o", tmp_path / "a.ply")
    assert result.exit_code == 2
    (suggested,) = re.findall(r"GB free: --resolution (\d+) fits", result.stderr)
    assert 100 < int(suggested) < 2048
    assert not (tmp_path / "a.ply").exists()


def test_how_much_memory_is_free_is_known_on_linux() -> None:
    free = free_memory()
    assert free is None or 10**6 < free < 10**14


def test_grid(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "field.npz"
    result = done("decode", model, "-o", out, "--grid", 24, "--resolution", 32, "--json")
    report = json.loads(result.stdout)
    with np.load(out, allow_pickle=False) as file:
        assert list(file["sdf"].shape) == report["samples"] == [24, 24, 24]
        assert file["origin"].tolist() == report["origin"]
        assert float(file["spacing"]) == report["spacing"]
        assert file["sdf"].min() < 0 < file["sdf"].max()
    refused(nisp("decode", model, "-o", out, "--grid", 24), "expected no file", "--force")
    again = done("decode", model, "-o", out, "--grid", 24, "--resolution", 32, "--force")
    assert f"{out}: 24 x 24 x 24 distances" in again.stdout


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("out.glb", ("--grid", 24), "--grid: expected with a .npz"),
        ("out.npz", (), "--grid: expected with a .npz"),
        ("out.npz", ("--grid", 24, "--target-error", 1), "--grid and --target-error"),
        ("out.npz", ("--grid", 24, "--keep-spurious"), "--grid and --keep-spurious"),
        ("out.npz", ("--grid", 2000), "16 to 1024"),
    ],
)
def test_a_grid_is_no_mesh(
    model: Path, tmp_path: Path, name: str, options: tuple[object, ...], said: str
) -> None:
    refused(nisp("decode", model, "-o", tmp_path / name, *options), said, "expected")
    assert not list(tmp_path.glob("out.*"))
