from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.texture import (
    base_color,
    data_maps,
    decode_image,
    distinct_names,
    image_size,
    linear_to_srgb,
    reencode,
    sample_texture,
    srgb_to_linear,
)

# Two columns, two rows; the value of a texel is column + 10 * row from the bottom.
SMALL = np.array([[[10.0], [11.0]], [[0.0], [1.0]]], dtype=np.float32)


def encoded(image: PIL.Image.Image, kind: str = "PNG") -> Texture:
    buffer = io.BytesIO()
    image.save(buffer, kind)
    return Texture("t.png", buffer.getvalue(), "image/png")


def sampled(
    u: float, v: float, wrap: tuple[str, str] = ("repeat", "repeat"), filter: str = "linear"
) -> float:
    return float(sample_texture(SMALL, np.array([[u, v]]), wrap, filter)[0, 0])


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "AVIF"])
def test_the_size_is_that_of_the_pixels(kind: str) -> None:
    texture = encoded(PIL.Image.new("RGB", (30, 20)), kind)
    assert image_size(texture) == (30, 20)
    assert decode_image(texture).shape == (20, 30, 4)


def test_the_size_of_what_is_no_image() -> None:
    with pytest.raises(MeshError, match=r"broken\.png: .*, found: bytes that make no image"):
        image_size(Texture("broken.png", b"no image", "image/png"))


def test_names_that_are_taken_get_a_number() -> None:
    names = ["a.png", "b.png", "A.PNG", "a.png", "a-2.png", "c"]
    distinct = ["a.png", "b.png", "A-2.PNG", "a-3.png", "a-2-2.png", "c"]
    assert distinct_names(names) == distinct


def test_origin_is_bottom_left() -> None:
    assert sampled(0.25, 0.25) == 0
    assert sampled(0.75, 0.25) == 1
    assert sampled(0.25, 0.75) == 10


def test_bilinear_weights() -> None:
    assert sampled(0.5, 0.25) == pytest.approx(0.5)
    assert sampled(0.25, 0.5) == pytest.approx(5)
    assert sampled(0.35, 0.45) == pytest.approx(0.2 + 4)


@pytest.mark.parametrize(
    ("wrap", "u", "value"),
    [
        ("repeat", 1.25, 0),
        ("repeat", -0.25, 1),
        ("repeat", 1.0, 0.5),
        ("clamp", 7.0, 1),
        ("clamp", -7.0, 0),
        ("mirror", 1.25, 1),
        ("mirror", -0.25, 0),
        ("mirror", 1.75, 0),
        ("mirror", 1.0, 1),
    ],
)
def test_wrap(wrap: str, u: float, value: float) -> None:
    assert sampled(u, 0.25, wrap=(wrap, "clamp")) == pytest.approx(value)
    turned = sample_texture(
        SMALL.transpose(1, 0, 2)[::-1, ::-1], np.array([[0.25, u]]), ("clamp", wrap)
    )
    assert float(turned[0, 0]) == pytest.approx(value)


@pytest.mark.parametrize("filter", ["linear", "nearest"])
def test_bytes_are_255ths(filter: str) -> None:
    random = np.random.default_rng(0)
    image, uvs = random.integers(0, 256, (5, 7, 4), np.uint8), random.random((50, 2))
    given = (image / np.float32(255)).astype(np.float32)
    repeat = ("repeat", "repeat")
    expected = sample_texture(given, uvs, repeat, filter)
    np.testing.assert_array_equal(sample_texture(image, uvs, repeat, filter), expected)


def test_nearest_takes_the_texel_under_the_point() -> None:
    assert sampled(0.49, 0.49, filter="nearest") == 0
    assert sampled(0.51, 0.49, filter="nearest") == 1
    assert sampled(-0.01, 0.51, filter="nearest") == 11


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("filter", ["linear", "nearest"])
def test_a_coordinate_that_is_not_finite_counts_as_0(odd: float, filter: str) -> None:
    assert sampled(odd, 0.3, filter=filter) == sampled(0.0, 0.3, filter=filter)
    assert sampled(0.3, odd, filter=filter) == sampled(0.3, 0.0, filter=filter)


def test_uv_far_outside_is_finite() -> None:
    values = sample_texture(SMALL, np.array([[1e300, -1e300], [-3e9, 3e18]]))
    assert np.isfinite(values).all()


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "L", "LA", "P", "1"])
def test_decode_widens_every_mode(mode: str) -> None:
    image = decode_image(encoded(PIL.Image.new("RGB", (3, 2), (255, 255, 255)).convert(mode)))
    assert image.shape == (2, 3, 4)
    assert image.dtype == np.float32
    assert (image == 1).all()


def test_decode_keeps_values_alpha_and_row_order() -> None:
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 3, 4)
    image = decode_image(encoded(PIL.Image.fromarray(pixels, "RGBA")))
    np.testing.assert_allclose(image * 255, pixels, atol=1e-4)


def test_decode_16_bit_gray() -> None:
    gray = np.array([[0, 65535 // 4]], dtype=np.uint16)
    image = decode_image(encoded(PIL.Image.fromarray(gray)))
    np.testing.assert_allclose(image[0, 1], [0.25, 0.25, 0.25, 1], atol=1e-4)


def test_the_transparent_value_of_16_bit_gray() -> None:
    gray = PIL.Image.fromarray(np.array([[7, 40_000]], np.uint16))
    file = io.BytesIO()
    gray.save(file, "PNG", transparency=7)
    assert decode_image(Texture("a.png", file.getvalue(), "image/png"))[0, :, 3].tolist() == [0, 1]


def test_decode_cmyk_jpeg() -> None:
    image = decode_image(encoded(PIL.Image.new("CMYK", (2, 2), (0, 0, 0, 0)), "JPEG"))
    np.testing.assert_allclose(image, 1, atol=0.02)


@pytest.mark.parametrize("kept", [0, 1, 20, 45, 60])
def test_broken_image_is_named(kept: int) -> None:
    whole = encoded(PIL.Image.effect_noise((16, 16), 50))
    with pytest.raises(MeshError, match=r"texture wood\.png"):
        decode_image(Texture("wood.png", whole.data[:kept], "image/png"))


def test_too_large_image_is_refused_before_decoding() -> None:
    texture = encoded(PIL.Image.new("1", (9500, 9500)))
    with pytest.raises(MeshError, match="texture"):
        decode_image(texture)


def test_srgb_round_trip_and_known_value() -> None:
    values = np.linspace(0, 1, 256, dtype=np.float32)
    np.testing.assert_allclose(linear_to_srgb(srgb_to_linear(values)), values, atol=1e-6)
    assert float(linear_to_srgb(np.array([0.5], dtype=np.float32))[0]) == pytest.approx(0.735357)


def test_base_color_without_map_is_the_factor_encoded() -> None:
    color = base_color(Material(base_color=(0.5, 0.0, 1.0, 0.25)), None, np.zeros((2, 2)))
    np.testing.assert_allclose(color, [[0.735357, 0, 1, 0.25]] * 2, atol=1e-5)


def test_base_color_multiplies_in_linear_light() -> None:
    material = Material(
        base_color=(0.5, 0.5, 0.5, 0.5), maps={"base_color": TextureMap(0, filter="nearest")}
    )
    image = np.full((1, 1, 4), 0.8, dtype=np.float32)
    color = base_color(material, image, np.zeros((1, 2)))
    expected = linear_to_srgb(srgb_to_linear(image[0]) * np.float32(0.5))[0, :3]
    np.testing.assert_allclose(color[0], [*expected, 0.4], atol=1e-6)


def test_reencoded_images_keep_their_pixels_and_different_names() -> None:
    image = PIL.Image.fromarray(np.full((8, 8, 3), (10, 200, 90), np.uint8))
    twice = [encoded(image), encoded(image, "JPEG")]
    for kind in ("webp", "avif", "jpeg"):
        again = reencode(twice, kind, 90)
        assert len({texture.name for texture in again}) == 2
        assert {texture.mime for texture in again} == {f"image/{kind}"}
        assert decode_image(again[0]) == pytest.approx(decode_image(twice[0]), abs=0.05)


def test_jpeg_leaves_transparent_images_alone() -> None:
    clear = encoded(PIL.Image.new("RGBA", (4, 4), (1, 2, 3, 100)))
    assert reencode([clear], "jpeg", 90) == (clear,)


def fine_normals(size: int = 32) -> Texture:
    """A normal map of which every other texel leans another way."""
    rows, columns = np.indices((size, size))
    pixels = np.full((size, size, 3), 128, np.uint8)
    pixels[..., 0] += (60 * (columns % 2)).astype(np.uint8)
    pixels[..., 1] += (60 * (rows % 2)).astype(np.uint8)
    pixels[..., 2] = 230
    pixels += np.random.default_rng(0).integers(0, 9, pixels.shape, np.uint8)
    return encoded(PIL.Image.fromarray(pixels))


@pytest.mark.parametrize("kind", ["webp", "avif", "jpeg"])
def test_data_keep_the_resolution_of_every_channel(kind: str) -> None:
    texture = fine_normals()
    before = decode_image(texture)
    (color,), (data,) = reencode([texture], kind, 95), reencode([texture], kind, 95, {0})
    errors = [np.abs(decode_image(each) - before).mean() for each in (color, data)]
    assert errors[1] < 0.35 * errors[0]
    assert kind != "webp" or errors[1] == 0


def test_data_stay_where_lossless_takes_more_bytes() -> None:
    noisy = PIL.Image.effect_noise((64, 64), 80).convert("RGB")
    texture = replace(encoded(noisy, "JPEG"), name="t.jpg", mime="image/jpeg")
    assert reencode([texture], "webp", 90, {0}) == (texture,)
    assert reencode([texture], "webp", 90)[0].mime == "image/webp"


def test_which_textures_are_data() -> None:
    maps = {"base_color": TextureMap(0), "normal": TextureMap(1), "emissive": TextureMap(3)}
    shared = {"occlusion": TextureMap(2), "metallic_roughness": TextureMap(3)}
    assert data_maps([Material(maps=maps), Material(maps=shared)]) == {1, 2, 3}
