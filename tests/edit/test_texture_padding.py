"""Padded gutters: what faces show stays, what none shows takes the colors beside it."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.texture import encode_image, image_bytes
from nispcodec.edit.texture_padding import used_texels, with_padded_textures
from tests.geometry.shapes import soup

RED, BLUE, GRAY = (255, 0, 0, 255), (0, 0, 255, 255), (90, 90, 90, 255)
SQUARE = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)


def atlas(wrap: str = "repeat", shift: float = 0.0) -> TexturedMesh:
    """Two charts, red at the lower left and blue at the upper right, gray between them."""
    pixels = np.full((16, 32, 4), GRAY, np.uint8)
    pixels[8:, :16], pixels[:4, 24:] = RED, BLUE
    uvs = np.concatenate([SQUARE / 2, SQUARE / 4 + 0.75])
    triangles = np.concatenate([np.pad(SQUARE, ((0, 0), (0, 0), (0, 1))) + n for n in (0, 3)])
    material = Material(maps={"base_color": TextureMap(0, wrap=(wrap, wrap))})
    data = encode_image(pixels, "png", 100)
    textures = tuple(Texture(f"{name}.png", data, "image/png") for name in "ab")
    return replace(soup(triangles, uvs + shift), materials=(material,), textures=textures)


@pytest.mark.parametrize("shift", [0.0, 3.0, -1.0])
def test_gutters_take_the_nearest_color_and_charts_keep_theirs(shift: float) -> None:
    mesh = atlas(shift=shift)
    image = image_bytes(with_padded_textures(mesh, 90)[0])
    before = image_bytes(mesh.textures[0])
    used = (before != GRAY).any(axis=2)
    assert (image[used] == before[used]).all()
    assert set(map(tuple, image.reshape(-1, 4))) == {RED, BLUE}
    assert tuple(image[7, 0]) == RED
    assert tuple(image[4, 31]) == BLUE


def test_faces_that_cross_the_border_of_a_repeated_image_use_both_sides() -> None:
    mesh = atlas()
    mesh = replace(mesh, uvs=mesh.uvs + np.array([0.5, 0.0]))
    used = used_texels(mesh, 0, 16, 32)
    assert used is not None
    # The upper right chart goes on at the left border, the lower left one ends at the right one.
    assert used[:4, 8:16].all()
    assert used[8:, 16:].all()
    assert used.sum() == 4 * 8 + 8 * 16


def test_an_image_that_is_used_everywhere_stays() -> None:
    mesh = atlas()
    assert used_texels(replace(mesh, uvs=mesh.uvs * 2), 0, 16, 32) is None


def test_images_that_no_face_shows_stay() -> None:
    mesh = atlas()
    assert with_padded_textures(mesh, 90)[1] is mesh.textures[1]


@pytest.mark.parametrize(("wrap", "stretch"), [("clamp", 1.5), ("mirror", 1.5), ("repeat", 4.0)])
def test_images_that_are_repeated_or_left_stay(wrap: str, stretch: float) -> None:
    mesh = atlas(wrap)
    mesh = replace(mesh, uvs=mesh.uvs * stretch)
    assert with_padded_textures(mesh, 90) == mesh.textures


@pytest.mark.parametrize("kind", ["jpeg", "webp", "png"])
def test_formats_and_names_stay(kind: str) -> None:
    mesh = atlas()
    pixels = image_bytes(mesh.textures[0])
    before = Texture("own.name", encode_image(pixels, kind, 90), f"image/{kind}")
    (after,) = with_padded_textures(replace(mesh, textures=(before,)), 90)
    assert (after.name, after.mime) == (before.name, before.mime)
    assert PIL.Image.open(io.BytesIO(after.data)).format == kind.upper()
    assert np.abs(image_bytes(after)[-1, -1].astype(int) - BLUE).max() < 100
