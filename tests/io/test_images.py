from __future__ import annotations

import io
import struct
import zlib

import numpy as np
import PIL.Image
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from nispcodec.core.errors import MeshError
from nispcodec.io.images import TextureShelf
from tests.io.files import image, outcome


def shelf() -> tuple[TextureShelf, list[str]]:
    warnings: list[str] = []
    return TextureShelf(warnings), warnings


@pytest.mark.parametrize(
    ("format", "mime", "name"),
    [
        ("PNG", "image/png", "a.png"),
        ("JPEG", "image/jpeg", "a.jpg"),
        ("WEBP", "image/webp", "a.webp"),
        ("AVIF", "image/avif", "a.avif"),
    ],
)
def test_web_formats_keep_their_bytes_whatever_their_name(
    format: str, mime: str, name: str
) -> None:
    textures, warnings = shelf()
    textures.add("some/a.dat", image(format), "a.dat")
    (texture,) = textures.textures
    assert (texture.data, texture.mime, texture.name) == (image(format), mime, name)
    assert warnings == []


@pytest.mark.parametrize("format", ["TGA", "BMP", "TIFF", "GIF"])
def test_other_formats_become_png_with_a_warning(format: str) -> None:
    textures, warnings = shelf()
    textures.add("a.x", image(format), "a.x")
    (texture,) = textures.textures
    assert (texture.mime, texture.name) == ("image/png", "a.png")
    pixels = np.asarray(PIL.Image.open(io.BytesIO(texture.data)).convert("RGB"))
    assert (pixels == (200, 30, 30)).all()
    assert warnings == [f"a.x: a {format} image, converted to PNG"]


@pytest.mark.parametrize("start", [b"v/1\x01", b"#?RADIANCE\n", b"\xabKTX 20"])
def test_sound_formats_that_are_not_supported_are_named(start: bytes) -> None:
    textures, warnings = shelf()
    assert textures.add("a.x", start + b"...", "a.x") is None
    assert "a.x: a" in warnings[0]
    assert "not supported" in warnings[0]
    assert textures.textures == []


def test_equal_bytes_are_one_texture_and_equal_names_stay_apart() -> None:
    textures, _ = shelf()
    added = [
        textures.add(name, image(color=color), name)
        for name, color in [("x/a.png", (1, 1, 1)), ("y/A.png", (2, 2, 2)), ("b.png", (1, 1, 1))]
    ]
    assert added == [0, 1, 0]
    assert [texture.name for texture in textures.textures] == ["a.png", "A_2.png"]


@pytest.mark.parametrize("name", ["../../evil.png", "C:\\x\\evil.png", "/evil.png", "evil.png"])
def test_names_are_bare(name: str) -> None:
    textures, _ = shelf()
    textures.add(name, image(), name)
    assert textures.textures[0].name == "evil.png"


@pytest.mark.parametrize("format", ["PNG", "JPEG", "WEBP"])
def test_a_damaged_image_is_an_error_that_names_the_file(format: str) -> None:
    noise = np.random.default_rng(0).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    buffer = io.BytesIO()
    PIL.Image.fromarray(noise).save(buffer, format)
    whole = buffer.getvalue()
    for damaged in (whole[: len(whole) // 2], b"not an image", b""):
        with pytest.raises(MeshError, match=r"wood\.x: expected an image"):
            shelf()[0].add("wood.x", damaged, "wood.x")


def test_an_image_bomb_is_refused_by_its_header() -> None:
    header = b"IHDR" + struct.pack(">II", 20_000, 20_000) + image()[24:29]
    bomb = image()[:12] + header + struct.pack(">I", zlib.crc32(header)) + image()[33:]
    with pytest.raises(MeshError, match=r"bomb\.png: expected an image.*pixels"):
        shelf()[0].add("bomb.png", bomb, "bomb.png")


@given(st.binary(max_size=100), st.integers(0, 60))
@example(b"v/1\x01", 0)
def test_any_bytes_give_a_texture_a_warning_or_a_mesh_error(noise: bytes, at: int) -> None:
    for data in (noise, image()[:at] + noise + image()[at + len(noise) :]):
        textures, warnings = shelf()
        found = outcome(textures.add, "a.png", data, "a.png")
        left_out = any(each.endswith("is not supported: left out") for each in warnings)
        assert (found is None) == left_out
        assert left_out or found == 0 or str(found).startswith("a.png: expected an image")
