"""Nothing that is there already is overwritten without --force, and this is known before the work.

The only exception is `encode` on an earlier output.
"""

from __future__ import annotations

import shutil
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

import nispcodec
from nispcodec.core.asset import Material, TextureMap
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests import tiny
from tests.cli.conftest import Encoder, done, nisp, refused

MINE = b"mine"
SIZE = ("--size", 16)
COARSE = ("--resolution", 16)
CASES: dict[str, tuple[tuple[object, ...], str]] = {
    "glb": (("decode", "tiny.nisp", "-o", "out.glb", *COARSE), "out.glb"),
    "obj": (("decode", "tiny.nisp", "-o", "out.obj", *COARSE), "out.obj"),
    "mtl": (("decode", "tiny.nisp", "-o", "out.obj", *COARSE), "out.mtl"),
    "image": (("decode", "tiny.nisp", "-o", "out.obj", *COARSE), "out_tiny.png"),
    "atlas": (
        ("decode", "tiny.nisp", "-o", "o.obj", *COARSE, "--rebake", 16),
        "o_baked_base_color.png",
    ),
    "picture": (("render", "tiny.nisp", "-o", "p.png", *SIZE), "p.png"),
    "turntable": (("render", "tiny.nisp", "-o", "p.png", *SIZE, "--turntable", 2), "p-001.png"),
    "animation": (("render", "tiny.nisp", "-o", "p.webp", *SIZE, "--turntable", 2), "p.webp"),
    "recode": (("recode", "tiny.nisp", "-o", "other.nisp"), "other.nisp"),
    "retexture": (
        ("retexture", "tiny.nisp", "--slot", "base_color=a.png", "-o", "other.nisp"),
        "other.nisp",
    ),
    "query": (("query", "tiny.nisp", "points.csv", "-o", "answers.csv"), "answers.csv"),
    "unpack": (("unpack", "tiny.nisp", "-o", "."), "tiny.png"),
    "sample": (("sample", "-o", "."), "sample.mtl"),
    "sheet": (("sheet", "ball.obj", "ball.obj", "-o", "s.png", "--size", 32), "s.png"),
}


@pytest.fixture
def folder(model: Path, mesh: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working folder, with everything that the CASES read."""
    (tmp_path / "a.png").write_bytes(tiny.document().textures[0].data)
    (tmp_path / "points.csv").write_text("1,2,3\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("case", CASES)
def test_what_is_there_stays_without_force(folder: Path, case: str) -> None:
    arguments, name = CASES[case]
    (folder / name).write_bytes(MINE)
    before = contents(folder)
    refused(nisp(*arguments), f"nisp: error: {name}: ", "--force")
    assert contents(folder) == before


@pytest.mark.parametrize("case", CASES)
def test_force_overwrites(folder: Path, case: str) -> None:
    if case == "atlas":
        pytest.importorskip("xatlas", reason="the extra `unwrap` is not installed")
    arguments, name = CASES[case]
    (folder / name).write_bytes(MINE)
    done(*arguments, "--force")
    assert (folder / name).read_bytes() != MINE


@pytest.mark.parametrize("case", ["glb", "image", "atlas"])
def test_a_decode_is_refused_before_the_work(
    folder: Path, case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments, name = CASES[case]
    (folder / name).write_bytes(MINE)
    monkeypatch.setattr(NispModel, "to_lods", None)
    refused(nisp(*arguments), name)


@pytest.mark.parametrize("case", ["picture", "turntable", "sheet"])
def test_pictures_are_refused_before_anything_is_drawn(
    folder: Path, case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments, name = CASES[case]
    (folder / name).write_bytes(MINE)
    monkeypatch.setattr(import_module("nispcodec.render.picture"), "Eye", None)
    monkeypatch.setattr(import_module("nispcodec.render.sheet"), "sheet", None)
    refused(nisp(*arguments), name)


def test_the_source_of_an_encode_survives_a_decode_beside_it(folder: Path) -> None:
    done("sample", "-o", ".")
    before = contents(folder)
    refused(nisp("decode", "tiny.nisp", "-o", "sample.obj"), "sample.mtl", "sample.obj")
    assert contents(folder) == before


def test_an_edited_image_survives_another_unpack(folder: Path) -> None:
    done("unpack", "tiny.nisp", "-o", "images")
    (folder / "images" / "tiny.png").write_bytes(MINE)
    refused(nisp("unpack", "tiny.nisp", "-o", "images"), "images/tiny.png")
    assert (folder / "images" / "tiny.png").read_bytes() == MINE


def test_all_that_is_in_the_way_is_named(folder: Path) -> None:
    for name in ("out.mtl", "out.obj"):
        (folder / name).write_bytes(MINE)
    refused(nisp("decode", "tiny.nisp", "-o", "out.obj"), "out.mtl: ", "out.obj")


def test_colors_want_no_mtl_in_the_way(folder: Path) -> None:
    (folder / "out.mtl").write_bytes(MINE)
    done("decode", "tiny.nisp", "-o", "out.obj", *COARSE, "--colors")
    assert (folder / "out.mtl").read_bytes() == MINE


def test_a_link_to_nowhere_is_in_the_way(folder: Path) -> None:
    (folder / "out.glb").symlink_to("nothing")
    refused(nisp("decode", "tiny.nisp", "-o", "out.glb", *COARSE), "out.glb")
    assert (folder / "out.glb").is_symlink()


def test_every_map_that_is_baked_counts(folder: Path) -> None:
    document = tiny.document()
    maps = {slot: TextureMap(0) for slot in ("base_color", "emissive")}
    path = folder / "shiny.nisp"
    path.write_bytes(
        pack(replace(document, materials=(Material("shiny", maps=maps), document.materials[1])))
    )
    (folder / "o_baked_emissive.png").write_bytes(MINE)
    refused(nisp("decode", path, "-o", "o.obj", "--rebake", 16), "o_baked_emissive.png")


def test_encode_replaces_its_earlier_output(encoder: Encoder, folder: Path) -> None:
    encoder(tiny.document())
    for _ in range(2):
        done("encode", "ball.obj", "-o", "ball.nisp")
    assert nispcodec.load(folder / "ball.nisp").document.networks


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (MINE, "this is no .nisp file"),
        (b"", "an empty file"),
        (pack(tiny.document())[:-1], "section TXTR"),
    ],
)
def test_encode_refuses_to_replace_anything_else(
    encoder: Encoder, folder: Path, content: bytes, words: str
) -> None:
    seen = encoder(tiny.document())
    (folder / "ball.nisp").write_bytes(content)
    refused(nisp("encode", "ball.obj", "-o", "ball.nisp"), "ball.nisp: ", words, "--force")
    assert (folder / "ball.nisp").read_bytes() == content
    assert seen == {}
    done("encode", "ball.obj", "-o", "ball.nisp", "--force")
    assert (folder / "ball.nisp").read_bytes() != content


def test_a_new_folder_is_made_and_its_files_are_new(folder: Path) -> None:
    done("sample", "-o", "deep/demo")
    refused(nisp("sample", "-o", "deep/demo"), "deep/demo/")
    shutil.rmtree(folder / "deep")
    done("sample", "-o", "deep/demo")


@pytest.mark.parametrize("command", [("sample",), ("unpack", "tiny.nisp")])
def test_a_file_in_place_of_the_folder_is_named(folder: Path, command: tuple[str, ...]) -> None:
    (folder / "taken").write_bytes(MINE)
    refused(nisp(*command, "-o", "taken"), "taken: expected a folder to write into, found a file")
    refused(nisp(*command, "-o", "taken/deeper"), "expected a folder to write into, found a file")
    assert (folder / "taken").read_bytes() == MINE


def test_images_of_one_name_are_unpacked_side_by_side(folder: Path) -> None:
    alike = Path(__file__).parents[1] / "conformance" / "textures-two-alike.nisp"
    (folder / "alike.nisp").write_bytes(alike.read_bytes())
    done("unpack", "alike.nisp", "-o", "images")
    assert sorted(contents(folder / "images")) == ["twin-2.png", "twin.png"]
