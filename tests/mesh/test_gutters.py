"""Padded gutters: what faces show stays, what none shows takes the colours beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.mesh.gutters import with_padded_gutters
from nispcodec.texture import as_texture, image_bytes
from tests.mesh.shapes import soup

RED, BLUE, GREY = (255, 0, 0, 255), (0, 0, 255, 255), (90, 90, 90, 255)
SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)


def atlas(wrap: str = "repeat", shift: float = 0.0) -> TexturedMesh:
    """Two charts, red at the lower left and blue at the upper right, grey between them."""
    pixels = np.full((16, 32, 4), GREY, np.uint8)
    pixels[8:, :16], pixels[:4, 24:] = RED, BLUE
    uvs = np.concatenate([SQUARE / 2, SQUARE / 4 + 0.75])
    triangles = np.concatenate([np.pad(SQUARE, ((0, 0), (0, 0), (0, 1))) + n for n in (0, 3)])
    material = Material(maps={"base_color": TextureMap(0, wrap=(wrap, wrap))})
    textures = (as_texture("a", pixels, "png", 100), as_texture("b", pixels, "png", 100))
    return replace(soup(triangles, uvs + shift), materials=(material,), textures=textures)


@pytest.mark.parametrize("shift", [0.0, 3.0, -1.0])
def test_gutters_take_the_nearest_colour_and_charts_keep_theirs(shift: float) -> None:
    mesh = atlas(shift=shift)
    image = image_bytes(with_padded_gutters(mesh)[0])
    before = image_bytes(mesh.textures[0])
    used = (before != GREY).any(axis=2)
    assert (image[used] == before[used]).all()
    assert set(map(tuple, image.reshape(-1, 4))) == {RED, BLUE}
    assert tuple(image[7, 0]) == RED
    assert tuple(image[4, 31]) == BLUE


def test_images_that_no_face_shows_stay() -> None:
    mesh = atlas()
    assert with_padded_gutters(mesh)[1] is mesh.textures[1]


@pytest.mark.parametrize(("wrap", "stretch"), [("clamp", 1.5), ("mirror", 1.5), ("repeat", 4.0)])
def test_images_that_are_repeated_or_left_stay(wrap: str, stretch: float) -> None:
    mesh = atlas(wrap)
    mesh = replace(mesh, uvs=mesh.uvs * stretch)
    assert with_padded_gutters(mesh) == mesh.textures


def test_names_stay_different() -> None:
    mesh = atlas()
    jpeg = Texture("a.jpg", mesh.textures[0].data, "image/png")
    maps = {"base_color": TextureMap(0), "emissive": TextureMap(1)}
    both = replace(mesh, textures=(mesh.textures[0], jpeg), materials=(Material(maps=maps),))
    assert [texture.name for texture in with_padded_gutters(both)] == ["a.png", "a-2.png"]
