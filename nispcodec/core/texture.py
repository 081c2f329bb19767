"""Textures as arrays: decode an image file's bytes and look colors up by UV.

The one sampler of the package: queries, metrics and pictures must agree on it to the last bit.
"""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace
from itertools import count
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import numpy as np

from nispcodec.core.arrays import (
    BoolArray,
    Float32Array,
    Float64Array,
    FloatArray,
    IndexArray,
    IntArray,
    Uint8Array,
)
from nispcodec.core.asset import Material, Texture
from nispcodec.core.errors import MeshError
from nispcodec.core.slots import BY_NAME

if TYPE_CHECKING:
    import PIL.Image


BROKEN_IMAGE = (
    OSError,
    ValueError,
    SyntaxError,
    EOFError,
    ArithmeticError,
    LookupError,
    RuntimeError,
    TypeError,
    struct.error,
    zlib.error,
)
"""What Pillow's readers raise for malformed files."""
# The formats of textures, by Pillow's name: others may start programs, or write where they like.
_FORMATS = ("PNG", "JPEG", "WEBP", "AVIF")
# What keeps every channel at the full resolution, by format.
_SHARP: dict[str, dict[str, Any]] = {
    "jpeg": {"subsampling": "4:4:4"},
    "avif": {"subsampling": "4:4:4"},
    "webp": {"lossless": True, "exact": True},
}


def what_is_broken(why: Exception) -> str:
    """Name what Pillow raised for a file; it calls bytes that it does not know by their address."""
    import PIL

    unknown = isinstance(why, PIL.UnidentifiedImageError)
    return "bytes that make no image" if unknown else str(why)


def image_size(texture: Texture) -> tuple[int, int]:
    """Width and height in pixels, by the image's header alone.

    Raises MeshError, naming the texture, for bytes that are no image.
    """
    import PIL.Image

    try:
        with (
            warnings.catch_warnings(action="ignore"),  # of bombs, and of tags that are broken
            PIL.Image.open(io.BytesIO(texture.data), formats=_FORMATS) as image,
        ):
            return image.size
    except (*BROKEN_IMAGE, PIL.Image.DecompressionBombError) as why:
        raise MeshError(
            f"texture {texture.name}: expected an image, found: {what_is_broken(why)}"
        ) from why


def decode_image(texture: Texture) -> Float32Array:
    """The texture's pixels: (h, w, 4) float32 in [0, 1], as `stored_pixels`."""
    found: Any = stored_pixels(texture)
    pixels: Float32Array = found / np.float32(255) if found.dtype == np.uint8 else found
    return pixels


def stored_pixels(texture: Texture) -> Float32Array | Uint8Array:
    """The texture's pixels (h, w, 4), RGBA as stored, top row first.

    They are uint8, and float32 in [0, 1] where the image is finer. Gray, palette and 16-bit images
    are widened; an image without alpha is opaque. Raises MeshError, naming the texture, for bytes
    that are no image and for more pixels than Pillow's limit of 89 million.
    """
    import PIL.Image

    try:
        # Pillow's guard against decompression bombs only warns below twice its limit.
        with (
            warnings.catch_warnings(action="ignore"),  # of tags that are broken
            warnings.catch_warnings(action="error", category=PIL.Image.DecompressionBombWarning),
            PIL.Image.open(io.BytesIO(texture.data), formats=_FORMATS) as image,
        ):
            return _to_rgba(image)
    except (
        *BROKEN_IMAGE,
        PIL.Image.DecompressionBombWarning,
        PIL.Image.DecompressionBombError,
    ) as why:
        raise MeshError(
            f"texture {texture.name}: expected an image, found: {what_is_broken(why)}"
        ) from why


def data_maps(materials: Iterable[Material]) -> frozenset[int]:
    """The numbers of the textures whose texels are data to some material, and no colors."""
    return frozenset(
        used.texture
        for material in materials
        for slot, used in material.maps.items()
        if not BY_NAME[slot].srgb
    )


def reencode(
    textures: Iterable[Texture], kind: str, quality: int, data: Collection[int] = ()
) -> tuple[Texture, ...]:
    """The same images as other files: `kind` "webp", "avif" or "jpeg", `quality` 1 to 100.

    Those whose numbers are in `data` keep all channels as sharp (`encode_image`); where that takes
    more bytes than the file they come from, they stay as they are. JPEG holds no transparency:
    images that have some stay too. Names get the suffix of their kind and stay different. Raises
    MeshError as `decode_image` does.
    """
    again = [
        _reencoded(texture, kind, quality, number in data)
        for number, texture in enumerate(textures)
    ]
    return named_apart(again)


def named_apart(textures: Sequence[Texture]) -> tuple[Texture, ...]:
    """The textures with names that differ (`distinct_names`)."""
    names = distinct_names([texture.name for texture in textures])
    return tuple(replace(each, name=name) for each, name in zip(textures, names, strict=True))


def distinct_names(names: Sequence[str]) -> list[str]:
    """The file names, a number added where one is taken: wood.png, wood-2.png.

    Names that differ in case alone are taken for the same: they are on some disks.
    """
    found: list[str] = []
    taken: set[str] = set()
    for name in names:
        path, tries, free = PurePath(name), count(2), name
        while free.casefold() in taken:
            free = f"{path.stem}-{next(tries)}{path.suffix}"
        found.append(free)
        taken.add(free.casefold())
    return found


def _reencoded(texture: Texture, kind: str, quality: int, is_data: bool) -> Texture:
    pixels = image_bytes(texture)
    if kind == "jpeg" and not _is_opaque(pixels):
        return texture
    encoded = encoded_texture(texture.name, pixels, kind, quality, is_data)
    return texture if is_data and len(encoded.data) >= len(texture.data) else encoded


def encoded_texture(
    name: str, pixels: Uint8Array, kind: str, quality: int, is_data: bool, tune: str | None = None
) -> Texture:
    """Pixels as a texture (`encode_image`), whose name gets the suffix of its kind."""
    suffix = "jpg" if kind == "jpeg" else kind
    data = encode_image(pixels, kind, quality, is_data, tune)
    return Texture(f"{PurePath(name).stem}.{suffix}", data, f"image/{kind}")


def image_bytes(texture: Texture) -> Uint8Array:
    """The texture's pixels (h, w, 4) uint8. Raises MeshError as `stored_pixels` does."""
    found: Any = stored_pixels(texture)
    pixels: Uint8Array = found if found.dtype == np.uint8 else np.rint(found * 255).astype(np.uint8)
    return pixels


def encode_image(
    pixels: Uint8Array, kind: str, quality: int, is_data: bool = False, tune: str | None = None
) -> bytes:
    """The bytes of an image file of pixels (h, w, 4) RGBA, sRGB-encoded, top row first.

    `kind` is "png", which ignores `quality`, "webp", "avif" or "jpeg"; `quality` is 1 to 100. Alpha
    is left out where it is 255 everywhere. Lossy formats hold color at half the resolution; where
    `is_data` they hold it at the full one, and WebP, which cannot, is lossless. `tune`, of AVIF
    alone, is what its bytes are best by: "psnr", "ssim", or None for what people say of pictures.
    """
    import PIL.Image

    options = dict(_SHARP.get(kind, {})) if is_data else {}
    if tune:
        options["advanced"] = {"tune": tune}
    file = io.BytesIO()
    image = PIL.Image.fromarray(pixels[..., :3] if _is_opaque(pixels) else pixels)
    image.save(file, kind, quality=quality, **options)
    return file.getvalue()


def _is_opaque(pixels: Uint8Array) -> bool:
    return bool((pixels[..., 3] == 255).all())


def sample_texture(
    image: Float32Array | Uint8Array,
    uv: FloatArray,
    wrap: tuple[str, str] = ("repeat", "repeat"),
    filter: str = "linear",
) -> Float32Array:
    """Colors (n, c) float32 of an (h, w, c) image at (n, 2) UVs, origin bottom-left.

    Of an image of bytes they are 255ths.
    Texel centers lie at half-integers, as in OpenGL and glTF; `wrap` and `filter` are those of
    `TextureMap`. A coordinate that is NaN or infinite counts as 0. Never filters between mip
    levels.
    """
    height, width = image.shape[:2]
    # Texels by one index each: numpy takes thrice as long for a row and a column.
    texels = image.reshape(height * width, -1)

    def at(places: IndexArray) -> Float32Array:
        found: Any = texels.take(places, axis=0)
        return found / np.float32(255) if found.dtype == np.uint8 else found

    u, v = np.nan_to_num(np.asarray(uv, dtype=np.float64), posinf=0.0, neginf=0.0).T
    x, y = u * width, (1.0 - v) * height
    if filter == "nearest":
        row, column = _texel(np.floor(y), height, wrap[1]), _texel(np.floor(x), width, wrap[0])
        return at(row * width + column)
    left, top = np.floor(x - 0.5), np.floor(y - 0.5)
    columns = [_texel(left + step, width, wrap[0]) for step in (0, 1)]
    rows = [_texel(top + step, height, wrap[1]) * width for step in (0, 1)]
    right = (x - 0.5 - left).astype(np.float32)[:, None]
    low = (y - 0.5 - top).astype(np.float32)[:, None]
    above, below = (_mix(at(row + columns[0]), at(row + columns[1]), right) for row in rows)
    return _mix(above, below, low)


def base_color(
    material: Material, image: Float32Array | Uint8Array | None, uv: FloatArray
) -> Float32Array:
    """Base color (n, 4) float32 at (n, 2) UVs: sRGB-encoded RGB and linear alpha, in [0, 1].

    `image` holds the pixels of the material's base-color map, None when it has none. The factor
    is linear (glTF 2.0, 3.9.2), so texels are decoded, multiplied and encoded again.
    """
    factor = np.asarray(material.base_color, dtype=np.float32)
    if image is None:
        return np.tile(_encoded(factor[None]), (len(uv), 1))
    used = material.maps["base_color"]
    texels = sample_texture(image, uv, used.wrap, used.filter)
    if (factor == 1).all():
        return texels
    linear = np.concatenate([srgb_to_linear(texels[:, :3]), texels[:, 3:]], axis=1)
    return _encoded(linear * factor)


def base_colors(
    materials: Sequence[Material],
    textures: Sequence[Texture],
    owners: IntArray,
    has_uv: BoolArray,
    uv: FloatArray,
) -> Float32Array:
    """Base colors (n, 4) float32 at (n, 2) UVs of the materials `owners` (n,), as `base_color`.

    Where `has_uv` (n,) is False the material shows its factor alone. Raises MeshError for a texture
    that does not decode.
    """

    def stored(texture: int) -> Float32Array | Uint8Array:
        return stored_pixels(textures[texture])

    return base_colors_of(materials, stored, owners, has_uv, uv)


def base_colors_of(
    materials: Sequence[Material],
    image_of: Callable[[int], Float32Array | Uint8Array],
    owners: IntArray,
    has_uv: BoolArray,
    uv: FloatArray,
) -> Float32Array:
    """As `base_colors`, of images that `image_of` has for the numbers of textures."""
    colors = np.empty((len(uv), 4), np.float32)
    for number in np.unique(owners).tolist():
        used = materials[number].maps.get("base_color")
        shown = has_uv & (used is not None)
        for image_shown in np.unique(shown[owners == number]).tolist():
            chosen = (owners == number) & (shown == image_shown)
            image = image_of(used.texture) if used and image_shown else None
            colors[chosen] = base_color(materials[number], image, uv[chosen])
    return colors


def srgb_to_linear(values: Float32Array) -> Float32Array:
    """IEC 61966-2-1 decoding, elementwise, of values in [0, 1]."""
    curved = ((values + 0.055) / 1.055) ** 2.4
    return np.where(values <= 0.04045, values / 12.92, curved).astype(np.float32)


def linear_to_srgb(values: Float32Array) -> Float32Array:
    """IEC 61966-2-1 encoding, elementwise, of values in [0, 1]."""
    curved = 1.055 * np.maximum(values, 0.0031308) ** (1 / 2.4) - 0.055
    return np.where(values <= 0.0031308, values * 12.92, curved).astype(np.float32)


def _to_rgba(image: PIL.Image.Image) -> Float32Array | Uint8Array:
    if image.mode.startswith("I"):  # Pillow clips 16-bit gray to 255 when converting
        values = np.asarray(image)[..., None]
        # The one value that is transparent, as for gray of 8 bits.
        alpha = (values != image.info.get("transparency", -1)).astype(np.float32)
        gray = values.astype(np.float32) / np.float32(65535)
        return np.concatenate([gray, gray, gray, alpha], axis=2)
    return np.asarray(image.convert("RGBA"))


def _encoded(linear: Float32Array) -> Float32Array:
    clipped = np.clip(linear, 0.0, 1.0)
    return np.concatenate([linear_to_srgb(clipped[:, :3]), clipped[:, 3:]], axis=1)


def _mix(first: Float32Array, second: Float32Array, share: Float32Array) -> Float32Array:
    return first + (second - first) * share


def _texel(index: Float64Array, size: int, wrap: str) -> IndexArray:
    # Wrapped as floats: a UV far outside [0, 1] would overflow an integer.
    if wrap == "repeat":
        index = np.remainder(index, size)
    elif wrap == "mirror":
        index = np.remainder(index, 2 * size)
        index = np.minimum(index, 2 * size - 1 - index)
    return np.clip(index, 0, size - 1).astype(np.intp)
