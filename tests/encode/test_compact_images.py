"""Images in few bytes: padded, never larger than they came, data as near as is asked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.texture import encode_image, image_bytes
from nispcodec.encode.compact_images import CompactImage, compact_images, compact_textures
from nispcodec.encode.total_config import CompactConfig
from tests.geometry.shapes import soup

SIDE = 64
HALF = np.array([[[0, 0], [0.5, 0], [0.5, 1]], [[0, 0], [0.5, 1], [0, 1]]], float)


def noisy(seed: int) -> Texture:
    """Smooth waves under noise, opaque, and noise alone where no face is."""
    rng = np.random.default_rng(seed)
    waves = 128 + 60 * np.sin(np.arange(SIDE) / (3 + seed))
    pixels = np.full((SIDE, SIDE, 4), 255.0)
    pixels[..., :3] = waves[:, None, None] + waves[None, :, None] / 4 - 32
    pixels[..., :3] += rng.normal(0, 10, (SIDE, SIDE, 3))
    pixels[:, SIDE // 2 :, :3] = rng.uniform(0, 255, (SIDE, SIDE // 2, 3))
    data = encode_image(pixels.clip(0, 255).astype(np.uint8), "png", 100)
    return Texture(f"{seed}.png", data, "image/png")


def asset() -> TexturedMesh:
    """Two triangles that show the left half of a color and a normal map."""
    triangles = np.pad(HALF, ((0, 0), (0, 0), (0, 1)))
    material = Material(maps={"base_color": TextureMap(0), "normal": TextureMap(1)})
    return replace(soup(triangles, HALF), materials=(material,), textures=(noisy(0), noisy(1)))


def test_what_no_face_shows_costs_next_to_nothing() -> None:
    mesh = asset()
    everywhere = replace(mesh, uvs=mesh.uvs * [2, 1])
    for padded, whole in zip(compact_images(mesh), compact_images(everywhere), strict=True):
        assert len(padded.at(60).data) < 0.6 * len(whole.at(60).data)


def test_a_higher_quality_takes_more_bytes_and_shows_what_faces_show() -> None:
    image = CompactImage(asset(), 0)
    sizes = [len(image.at(quality).data) for quality in (1, 30, 60, 90)]
    assert sizes == sorted(sizes)
    shown = image_bytes(image.at(90))[:, : SIDE // 2].astype(float)
    assert np.abs(shown - image_bytes(image.original)[:, : SIDE // 2]).mean() < 8


def test_an_image_that_is_small_already_stays_as_it_is() -> None:
    data = encode_image(np.full((4, 4, 4), 255, np.uint8), "png", 100)
    white = Texture("white.png", data, "image/png")
    mesh = replace(asset(), textures=(white, white))
    first, second = compact_textures(mesh, 90, CompactConfig())
    assert first.data == second.data == data
    assert first.name != second.name


def test_data_is_as_near_as_is_asked_or_exact() -> None:
    before = image_bytes(asset().textures[1])[:, : SIDE // 2].astype(float)
    for most in (0.02, 0.0):
        image = CompactImage(asset(), 1, CompactConfig(most_error=most))
        after = image_bytes(image.near(10))[:, : SIDE // 2]
        error = np.sqrt(np.square((after - before) / 255).sum(axis=-1).mean())
        assert error <= most


def test_colors_have_the_quality_that_was_asked_for() -> None:
    color, _ = compact_textures(asset(), 40, CompactConfig())
    assert color == CompactImage(asset(), 0).at(40)
    assert color.name == "0.avif"
