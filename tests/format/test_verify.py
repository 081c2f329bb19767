"""`verify` finds what the parser cannot: images that are not what they say."""

from __future__ import annotations

import dataclasses
import struct
import zlib

import pytest

from nispcodec.core.asset import Texture
from nispcodec.core.errors import MeshError
from nispcodec.core.texture import decode_image
from nispcodec.format import pack
from nispcodec.format.verify import verify
from tests.format.documents import full, tiny

PNG = b"\x89PNG\r\n\x1a\n and so on"


def decodes(texture: Texture) -> None:
    """Any image will do."""


def with_image(data: bytes, mime: str = "image/png") -> bytes:
    """The full document with this as both of its images."""
    texture = Texture("a.png", data, mime)
    return pack(dataclasses.replace(full(), textures=(texture, texture)))


def test_a_sound_file() -> None:
    assert verify(pack(tiny()), decodes) == []
    assert verify(with_image(PNG), decodes) == []


def test_the_parsers_error_is_the_only_problem() -> None:
    problems = verify(pack(tiny())[:-1], decodes)
    assert [(each.section, each.field) for each in problems] == [("NETS", "stored_length")]


@pytest.mark.parametrize(
    ("mime", "data"),
    [
        ("image/jpeg", b"\xff\xd8\xff\xe0"),
        ("image/webp", b"RIFF\0\0\0\0WEBP"),
        ("image/avif", b"\0\0\0\x20ftypavif"),
    ],
)
def test_every_type_is_known_by_its_first_bytes(mime: str, data: bytes) -> None:
    assert verify(with_image(data, mime), decodes) == []
    problems = verify(with_image(PNG, mime), decodes)
    assert [(each.section, each.field) for each in problems] == [
        ("TXTR", "textures.0"),
        ("TXTR", "textures.1"),
    ]


def test_an_image_bomb_is_refused_by_its_header() -> None:
    chunks = (b"IHDR" + struct.pack(">II5B", 60_000, 60_000, 8, 2, 0, 0, 0), b"IDAT")
    bomb = PNG[:8]
    for chunk in chunks:
        bomb += struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    problems = verify(with_image(bomb), decode_image)
    assert [(each.section, each.field) for each in problems] == [
        ("TXTR", "textures.0"),
        ("TXTR", "textures.1"),
    ]
    assert "3600000000 pixels" in str(problems[0].found)


def test_images_that_do_not_decode() -> None:
    def fails(texture: Texture) -> None:
        raise MeshError("too bad")

    problems = verify(with_image(PNG), fails)
    assert [str(each.found) for each in problems] == ["too bad"] * 2
