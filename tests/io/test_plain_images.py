"""Images that are written for other programs: the same texels, and nothing that changes them."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import nispcodec
from nispcodec.core.asset import Texture
from nispcodec.core.errors import MeshError
from nispcodec.core.texture import image_bytes
from nispcodec.io.write.plain_images import plain_image

IMAGES = sorted((Path(__file__).parents[1] / "conformance").glob("image-*.nisp"))
MIMES = ("image/png", "image/jpeg", "image/webp")


@pytest.mark.parametrize("path", IMAGES, ids=lambda path: path.stem)
def test_any_reader_finds_the_texels_that_ours_does(path: Path) -> None:
    for texture in nispcodec.load(path).document.textures:
        found = plain_image(texture, MIMES)
        np.testing.assert_array_equal(image_bytes(found), image_bytes(texture))
        image = Image.open(BytesIO(found.data))
        assert Image.MIME[image.format or ""] == found.mime
        assert not {"icc_profile", "gamma", "exif", "dpi"} & set(image.info)
        assert not image.getexif()


def test_there_are_profiles_and_turns_among_these() -> None:
    infos = [
        Image.open(BytesIO(each.data)).info
        for path in IMAGES
        for each in nispcodec.load(path).document.textures
    ]
    for key in ("icc_profile", "gamma", "exif"):
        assert sum(key in info for info in infos) >= 1, key


def test_what_says_nothing_stays_as_it_is_to_the_byte() -> None:
    for kind in ("PNG", "JPEG", "WEBP"):
        data = BytesIO()
        Image.new("RGB", (5, 3), (200, 30, 30)).save(data, kind)
        texture = Texture("x", data.getvalue(), Image.MIME[kind])
        assert plain_image(texture, MIMES).data == texture.data


@pytest.mark.parametrize("mime", MIMES)
def test_what_is_malformed_stays_as_it_is(mime: str) -> None:
    for data in (
        b"",
        b"-",
        b"\x89PNG\r\n\x1a\n" + b"\xff" * 30,
        b"\xff\xd8\xff\xe1\0",
        b"RIFF" * 5,
    ):
        assert plain_image(Texture("x", data, mime), MIMES).data == data


def test_an_image_that_is_none_and_must_be_converted_is_refused() -> None:
    with pytest.raises(MeshError):
        plain_image(Texture("x", b"none", "image/avif"), MIMES)
