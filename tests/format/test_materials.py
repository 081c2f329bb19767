from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.asset import MIME_TYPES, Material, Texture, TextureMap
from nispcodec.core.errors import FormatError
from nispcodec.core.slots import SLOTS
from nispcodec.format.materials import (
    decode_material,
    decode_textures,
    encode_material,
    encode_textures,
)
from tests.format.documents import materials

ENDINGS = st.sampled_from(["", ".png", ".jpg", ".webp", ".avif", ".", ".png.png", ".PNG", ".jpeg"])
TEXTURES = st.builds(
    Texture,
    st.builds(str.__add__, st.text("ab .", max_size=4), ENDINGS).filter(
        lambda name: "." in name and name not in (".", "..")
    ),
    st.binary(min_size=1, max_size=9),
    st.sampled_from(MIME_TYPES),
)


def test_the_usual_material_takes_nothing() -> None:
    assert encode_material(Material()) == {}
    assert decode_material(0, {}) == Material()


@given(materials(3))
@settings(max_examples=60)
def test_any_material_comes_back(material: Material) -> None:
    assert decode_material(4, encode_material(material)) == material


def test_a_slot_is_its_place_in_the_table() -> None:
    for number, slot in enumerate(SLOTS, 1):
        assert encode_material(Material(maps={slot: TextureMap(0)})) == {9: {number: {}}}


@given(st.lists(TEXTURES, max_size=4))
def test_names_types_and_lengths_of_textures_come_back(textures: list[Texture]) -> None:
    """But for the length of the last: it has what is left."""
    lengths = [len(texture.data) for texture in textures[:-1]]
    wanted = [
        (texture.name, texture.mime, length)
        for texture, length in zip(textures, [*lengths, None], strict=bool(textures))
    ]
    assert list(decode_textures(encode_textures(textures))) == wanted


@pytest.mark.parametrize(
    ("material", "text"),
    [
        (Material("m", maps={"gloss": TextureMap(0)}), r"materials\.m\.maps: .*found gloss"),
        (
            Material("m", maps={"normal": TextureMap(0, ("clamp", "tile"))}),
            r"materials\.m\.maps\.normal\.wrap_v: expected one of repeat, .*found tile",
        ),
        (
            Material("m", maps={"normal": TextureMap(0, filter="cubic")}),
            r"materials\.m\.maps\.normal\.filter: expected one of linear, nearest, found cubic",
        ),
    ],
)
def test_maps_that_no_file_can_hold(material: Material, text: str) -> None:
    with pytest.raises(FormatError, match=text):
        encode_material(material)


def test_an_image_has_bytes() -> None:
    with pytest.raises(FormatError, match=r"textures\.a\.png\.length: expected at least 1 byte"):
        encode_textures([Texture("a.png", b"", "image/png")])


def test_a_texture_of_another_type() -> None:
    with pytest.raises(FormatError, match=r"textures\.a\.gif\.mime: .*found image/gif"):
        encode_textures([Texture("a.gif", b"GIF", "image/gif")])
