from __future__ import annotations

import io
import struct
import warnings as python_warnings
import zlib

import numpy as np
import PIL.Image
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from nispcodec.core.asset import Texture
from nispcodec.core.texture import decode_image, image_bytes, image_size
from nispcodec.io.images import TextureShelf
from tests.io.files import image


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


def test_a_jpeg_in_cmyk_becomes_png_with_a_warning() -> None:
    textures, warnings = shelf()
    buffer = io.BytesIO()
    PIL.Image.new("CMYK", (8, 8), (0, 255, 255, 0)).save(buffer, "JPEG")
    textures.add("a.jpg", buffer.getvalue(), "a.jpg")
    (texture,) = textures.textures
    assert texture.name == "a.png"
    assert np.allclose(decode_image(texture)[0, 0], (1, 0, 0, 1), atol=0.02)
    assert warnings == ["a.jpg: a JPEG in CMYK image, converted to PNG"]


@pytest.mark.parametrize("format", ["TGA", "BMP", "TIFF", "GIF"])
def test_other_formats_become_png_with_a_warning(format: str) -> None:
    textures, warnings = shelf()
    textures.add("a.x", image(format), "a.x")
    (texture,) = textures.textures
    assert (texture.mime, texture.name) == ("image/png", "a.png")
    pixels = np.asarray(PIL.Image.open(io.BytesIO(texture.data)).convert("RGB"))
    assert (pixels == (200, 30, 30)).all()
    assert warnings == [f"a.x: a {format} image, converted to PNG"]


@pytest.mark.parametrize(
    "start",
    [
        b"v/1\x01",
        b"#?RADIANCE\n",
        b"\xabKTX 11",
        b"<svg>",
        b'<?xml version="1.0"?>\n<svg width="1"/>',
    ],
)
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


def noise_image(format: str) -> bytes:
    noise = np.random.default_rng(0).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    buffer = io.BytesIO()
    PIL.Image.fromarray(noise).save(buffer, format)
    return buffer.getvalue()


@pytest.mark.parametrize("format", ["PNG", "WEBP", "TIFF"])
def test_a_damaged_image_is_left_out_and_named(format: str) -> None:
    whole = noise_image(format)
    for damaged in (whole[: len(whole) // 2], b"not an image", b""):
        textures, warnings = shelf()
        assert textures.add("wood.x", damaged, "wood.x") is None
        assert warnings[0].startswith("wood.x: expected an image that can be decoded, found")
        assert textures.textures == []


def test_bytes_that_are_no_image_are_called_that() -> None:
    textures, warnings = shelf()
    textures.add("wood.x", b"not an image", "wood.x")
    found = "expected an image that can be decoded, found: bytes that make no image"
    assert warnings == [f"wood.x: {found}: left out"]


def test_a_jpeg_that_is_cut_short_is_kept() -> None:
    whole = noise_image("JPEG")
    textures, warnings = shelf()
    assert textures.add("wood.jpg", whole[: len(whole) // 2], "wood.jpg") == 0
    assert warnings == ["wood.jpg: cut short: what is missing of the image is gray"]
    upper = image_bytes(textures.textures[0])[:8]
    right = image_bytes(Texture("wood.jpg", whole, "image/jpeg"))[:8]
    assert (upper == right).all()


WIDE = [
    ("u1", "L", 128),
    ("u2", "I;16", 32768),
    ("f4", "F", 0.5),
]


@pytest.mark.parametrize(("dtype", "mode", "value"), WIDE)
def test_gray_of_any_type_is_as_bright(dtype: str, mode: str, value: float) -> None:
    pixels = PIL.Image.fromarray(np.full((4, 4), value, dtype))
    assert pixels.mode == mode
    buffer = io.BytesIO()
    pixels.save(buffer, "TIFF")
    textures, warnings = shelf()
    textures.add("a.tif", buffer.getvalue(), "a.tif")
    assert warnings == ["a.tif: a TIFF image, converted to PNG"]
    assert np.abs(decode_image(textures.textures[0])[..., :3] - 0.5).max() < 0.01


def gray_tiff(value: int, bits: int, order: str = "<", photometric: int = 1) -> bytes:
    """A TIFF of one texel."""
    tags = {256: 1, 257: 1, 258: bits, 259: 1, 262: photometric, 273: 8, 277: 1, 278: 1}
    tags[279] = bits // 8
    rows = b"".join(struct.pack(f"{order}HHII", tag, 4, 1, number) for tag, number in tags.items())
    texel = struct.pack(f"{order}{'H' if bits == 16 else 'I'}", value).ljust(4, b"\0")
    mark = b"II*\0" if order == "<" else b"MM\0*"
    head = mark + struct.pack(f"{order}I", 12) + texel
    return head + struct.pack(f"{order}H", len(tags)) + rows + bytes(4)


# Pillow reads no others: those are left out with a warning.
@pytest.mark.parametrize(
    ("bits", "order", "photometric"), [(16, "<", 1), (16, ">", 1), (16, "<", 0), (32, "<", 1)]
)
@pytest.mark.parametrize("share", [0, 1, 2, 4])
def test_gray_of_wide_integers_is_as_bright(
    bits: int, order: str, photometric: int, share: int
) -> None:
    value = (2**bits - 1) * share // 4
    textures, _ = shelf()
    textures.add("a.tif", gray_tiff(value, bits, order, photometric), "a.tif")
    bright = share / 4 if photometric else 1 - share / 4
    assert np.abs(decode_image(textures.textures[0])[0, 0, 0] - bright) < 1e-4


def test_floats_beyond_the_range_are_cut_off() -> None:
    buffer = io.BytesIO()
    PIL.Image.fromarray(np.array([[-1.0, 7.0, np.nan, np.inf, 1.0]], "f4")).save(buffer, "TIFF")
    textures, warnings = shelf()
    textures.add("a.tif", buffer.getvalue(), "a.tif")
    assert decode_image(textures.textures[0])[0, :, 0].tolist() == [0, 1, 0, 1, 1]
    assert warnings == [
        "a.tif: expected numbers from 0 to 1, found 4 texels with others: cut to it",
        "a.tif: a TIFF image, converted to PNG",
    ]


def with_orientation(number: int, format: str) -> tuple[bytes, np.ndarray]:
    """A file of 16 x 8 texels, and these as they are stored."""
    texels = np.zeros((8, 16, 3), np.uint8)
    texels[:4, :8], texels[:4, 8:] = (200, 0, 0), (0, 200, 0)
    exif = PIL.Image.Exif()
    exif[274] = number
    buffer = io.BytesIO()
    more = {"tiffinfo": {274: number}} if format == "TIFF" else {"exif": exif}
    PIL.Image.fromarray(texels).save(buffer, format, **more)
    return buffer.getvalue(), texels


@pytest.mark.parametrize("format", ["TIFF", "PNG", "JPEG"])
@pytest.mark.parametrize("number", range(1, 9))
def test_texels_are_taken_as_they_are_stored(number: int, format: str) -> None:
    data, texels = with_orientation(number, format)
    textures, warnings = shelf()
    textures.add("a.x", data, "a.x")
    found = decode_image(textures.textures[0])[..., :3] * 255
    assert found.shape == texels.shape
    assert np.abs(found - texels).mean() < 9
    assert sum("EXIF orientation, which no mesh heeds" in each for each in warnings) == (number > 1)


def test_broken_tags_of_an_image_are_no_matter() -> None:
    data, _ = with_orientation(6, "JPEG")
    broken = data.replace(b"\x01\x12\0\x03\0\0\0\x01", b"\x01\x12\0\x02\0\0\x09\xff")
    broken = broken.replace(b"\x12\x01\3\0\1\0\0\0", b"\x12\x01\2\0\xff\x09\0\0")
    assert broken != data
    textures, said = shelf()
    with python_warnings.catch_warnings(action="error"):
        textures.add("a.jpg", broken, "a.jpg")
        assert image_bytes(textures.textures[0]).shape == (8, 16, 4)
        assert image_size(textures.textures[0]) == (16, 8)
    assert said == []


def test_a_texture_that_was_here_from_the_start_is_found() -> None:
    textures, _ = shelf()
    textures.textures = [Texture("a.png", image(), "image/png")]
    assert textures.add("b.png", image(), "b.png") == 0
    assert len(textures.textures) == 1


def test_names_fit_file_systems_and_the_format() -> None:
    textures, _ = shelf()
    textures.add("\u00e4" * 200 + "\udc80\x7f.png", image(), "a.png")
    assert len(textures.textures[0].name.encode()) <= 104


def test_an_image_bomb_is_refused_by_its_header() -> None:
    header = b"IHDR" + struct.pack(">II", 20_000, 20_000) + image()[24:29]
    bomb = image()[:12] + header + struct.pack(">I", zlib.crc32(header)) + image()[33:]
    textures, warnings = shelf()
    assert textures.add("bomb.png", bomb, "bomb.png") is None
    (warning,) = warnings
    assert "bomb.png: expected an image of at most 89478485 pixels, found 400000000" in warning
    assert warning.endswith("(8192 x 8192 can be read): left out")


@given(st.binary(max_size=100), st.integers(0, 60))
@example(b"v/1\x01", 0)
def test_any_bytes_give_a_texture_or_a_warning(noise: bytes, at: int) -> None:
    for data in (noise, image()[:at] + noise + image()[at + len(noise) :]):
        textures, warnings = shelf()
        found = textures.add("a.png", data, "a.png")
        left_out = any(each.endswith(": left out") for each in warnings)
        assert (found is None) == left_out
        assert left_out or found == 0
