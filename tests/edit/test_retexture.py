from __future__ import annotations

import dataclasses
from io import BytesIO

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.document import Document
from nispcodec.core.errors import NispError
from nispcodec.edit.retexture import retextured
from nispcodec.format import inspect, pack, unpack
from tests import tiny


def image(size: tuple[int, int] = (5, 3), kind: str = "PNG") -> bytes:
    file = BytesIO()
    PIL.Image.new("RGB", size, (0, 200, 100)).save(file, kind)
    return file.getvalue()


def section(data: bytes, code: str) -> bytes:
    (found,) = [each for each in inspect(data) if each.code == code]
    return data[found.offset : found.offset + found.stored_length]


def two_materials() -> Document:
    other = tiny.png(np.zeros((2, 2, 3), np.uint8), "other.png")
    document = tiny.document()
    first = document.materials[0]
    second = Material("second", maps={"base_color": TextureMap(1), "normal": TextureMap(0)})
    return dataclasses.replace(
        document, materials=(first, second), textures=(*document.textures, other)
    )


def test_the_networks_stay_byte_for_byte() -> None:
    document = tiny.document()
    changed, warnings = retextured(document, "base_color", image(), "new.png")
    before, after = pack(document), pack(changed)
    assert section(before, "NETS") == section(after, "NETS")
    assert before != after
    assert warnings == ()
    back = unpack(after)
    assert [each.data for each in back.textures] == [image()]
    assert back.materials[0].maps["base_color"] == document.materials[0].maps["base_color"]


@pytest.mark.parametrize("size", [(1, 1), (300, 2), (7, 1000)])
def test_any_size_and_aspect(size: tuple[int, int]) -> None:
    changed, _ = retextured(tiny.document(), "base_color", image(size), "new.png")
    assert changed.textures[0].data == image(size)


def test_a_format_that_viewers_do_not_know_is_converted() -> None:
    changed, warnings = retextured(tiny.document(), "base_color", image(kind="TIFF"), "a.tiff")
    assert changed.textures[0].mime == "image/png"
    assert "converted to PNG" in warnings[0]


def test_one_material_of_several() -> None:
    document = two_materials()
    changed, _ = retextured(document, "base_color", image(), "new.png", "painted")
    # The old texture is still the second material's normal map.
    assert [each.name for each in changed.textures] == ["tiny.png", "other.png", "new.png"]
    assert changed.materials[0].maps["base_color"].texture == 2
    assert changed.materials[1] == document.materials[1]


def test_a_texture_that_nothing_uses_goes_and_the_others_are_renumbered() -> None:
    changed, _ = retextured(two_materials(), "normal", image(), "new.png")
    changed, _ = retextured(changed, "base_color", image((9, 9)), "newer.png", "painted")
    assert [each.name for each in changed.textures] == ["other.png", "new.png", "newer.png"]
    assert {s: m.texture for s, m in changed.materials[1].maps.items()} == {
        "base_color": 0,
        "normal": 1,
    }


def test_names_stay_different() -> None:
    changed, _ = retextured(two_materials(), "normal", image(), "other.png")
    assert len({each.name for each in changed.textures}) == len(changed.textures)


@pytest.mark.parametrize(
    ("slot", "data", "material", "words"),
    [
        ("color", image(), None, "slot: expected one of base_color"),
        ("emissive", image(), None, "slot emissive: expected a texture there, found base_color"),
        ("base_color", image(), "gold", "expected one of 'painted', 'second', found 'gold'"),
        ("base_color", image(), None, "a material to be named, found 'painted', 'second'"),
        ("base_color", b"no image", "painted", "new.png: expected an image"),
        ("base_color", b"v/1\x01 rest", "painted", "OpenEXR image is not supported"),
    ],
)
def test_what_cannot_be_done_is_said(
    slot: str, data: bytes, material: str | None, words: str
) -> None:
    with pytest.raises(NispError, match=words):
        retextured(two_materials(), slot, data, "new.png", material)
