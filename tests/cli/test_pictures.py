from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import PIL.Image
import PIL.ImageSequence
import pytest

import nispcodec
from nispcodec.render.images import SUFFIXES
from tests.cli.conftest import nisp


def pixels(path: Path) -> np.ndarray:
    with PIL.Image.open(path) as image:
        return np.asarray(image.convert("RGBA"))


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_render(model: Path, tmp_path: Path, suffix: str) -> None:
    out = tmp_path / f"out{suffix}"
    result = nisp("render", model, "-o", out, "--size", 32, "--view", "front")
    assert result.exit_code == 0, result.output
    assert pixels(out).shape == (32, 32, 4)
    assert pixels(out)[16, 16, 3] == 255


def test_turntable_of_numbered_pictures(model: Path, tmp_path: Path) -> None:
    result = nisp("render", model, "-o", tmp_path / "t.png", "--size", 16, "--turntable", 3)
    assert result.exit_code == 0, result.output
    names = sorted(each.name for each in tmp_path.glob("t*.png"))
    assert names == ["t-000.png", "t-001.png", "t-002.png"]
    assert not np.array_equal(pixels(tmp_path / names[0]), pixels(tmp_path / names[1]))


def test_turntable_as_an_animation(model: Path, tmp_path: Path) -> None:
    out = tmp_path / "t.webp"
    assert nisp("render", model, "-o", out, "--size", 16, "--turntable", 3).exit_code == 0
    with PIL.Image.open(out) as image:
        assert len(list(PIL.ImageSequence.Iterator(image))) == 3


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--view", "behind"), "--view: expected front"),
        (("--channel", "smell"), "--channel: expected one of color, "),
        (("--size", 4), "--size"),
        (("--fov", 170), "--fov"),
    ],
)
def test_bad_options(model: Path, tmp_path: Path, options: tuple[str, object], words: str) -> None:
    result = nisp("render", model, "-o", tmp_path / "o.png", *options)
    assert result.exit_code == 2
    assert words in result.stderr
    assert not (tmp_path / "o.png").exists()


def test_sheet(mesh: Path, tmp_path: Path) -> None:
    out = tmp_path / "sheet.png"
    result = nisp("sheet", mesh, mesh, "-o", out, "--size", 32, "--json")
    assert result.exit_code == 0, result.output
    assert pixels(out).shape[1] == 7 * 32
    assert json.loads(result.stdout)["pictures"]["ssim"] == pytest.approx(1)


def test_unpack_edit_retexture(model: Path, tmp_path: Path) -> None:
    folder, new = tmp_path / "textures", tmp_path / "new.nisp"
    assert nisp("unpack", model, "-o", folder).exit_code == 0
    original = nispcodec.load(model).document.textures[0]
    image = folder / original.name
    assert image.read_bytes() == original.data
    PIL.Image.new("RGB", (4, 9), (10, 20, 30)).save(image)
    result = nisp("retexture", model, "--slot", f"base_color={image}", "-o", new)
    assert result.exit_code == 0, result.output
    assert nispcodec.load(new).document.textures[0].data == image.read_bytes()


def test_info_lists_textures(model: Path) -> None:
    result = nisp("info", model, "--textures", "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["textures"] == [
        {
            "name": "tiny.png",
            "mime": "image/png",
            "bytes": len(nispcodec.load(model).document.textures[0].data),
            "pixels": "2 x 2",
            "used_by": "painted.base_color",
        }
    ]


@pytest.mark.parametrize(
    ("slot", "words"),
    [
        ("base_color", "expected SLOT=IMAGE"),
        ("base_color=missing.png", "missing.png: expected a file, found none"),
        ("gloss=missing.png", "expected one of base_color, "),
    ],
)
def test_retexture_says_what_is_wrong(model: Path, tmp_path: Path, slot: str, words: str) -> None:
    result = nisp("retexture", model, "--slot", slot, "-o", tmp_path / "n.nisp")
    assert result.exit_code == 2
    assert words in result.stderr
    assert not (tmp_path / "n.nisp").exists()
