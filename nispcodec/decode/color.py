"""Texture lookups: bilinear or nearest, wrap modes, UV origin bottom-left."""

from __future__ import annotations

from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from nispcodec.asset import Material, Texture, TextureMap
from nispcodec.errors import FormatError

MAX_PIXELS = 1 << 28

Floats = NDArray[np.float32]


def decoded(texture: Texture) -> NDArray[np.uint8]:
    """The texture's stored values as (height, width, 4) uint8 RGBA, first row on top."""
    try:
        with Image.open(BytesIO(texture.data)) as image:
            if image.width * image.height > MAX_PIXELS:
                raise FormatError(
                    "TEXS", texture.name, f"at most {MAX_PIXELS} pixels", f"{image.size}"
                )
            return np.asarray(image.convert("RGBA"))
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise FormatError("TEXS", texture.name, "a readable image", str(error)) from error


def looked_up(pixels: NDArray[np.uint8], used: TextureMap, uvs: Floats) -> Floats:
    """Stored values at UVs: (n, 2) -> (n, 4) float32 in [0, 1], not converted to linear light."""
    height, width = pixels.shape[:2]
    x = uvs[:, 0].astype(np.float64) * width - 0.5
    y = (1 - uvs[:, 1].astype(np.float64)) * height - 0.5
    if used.filter == "nearest":
        x, y = np.floor(x + 0.5), np.floor(y + 0.5)
    left, top = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    across, down = (x - left)[:, None], (y - top)[:, None]
    columns = [_wrapped(left + i, width, used.wrap[0]) for i in (0, 1)]
    rows = [_wrapped(top + i, height, used.wrap[1]) for i in (0, 1)]
    upper = pixels[rows[0], columns[0]] * (1 - across) + pixels[rows[0], columns[1]] * across
    lower = pixels[rows[1], columns[0]] * (1 - across) + pixels[rows[1], columns[1]] * across
    result: Floats = ((upper * (1 - down) + lower * down) / 255).astype(np.float32)
    return result


def base_color(
    material: Material, pixels: NDArray[np.uint8] | None, uvs: Floats | None, count: int
) -> Floats:
    """Base colour (n, 4): the stored texel values times the material's factor, in [0, 1].

    The factor, linear in glTF, is put into the texture's sRGB encoding before the product, so that
    a material without texture answers its factor's sRGB value.
    """
    factor = np.array([*map(_srgb, material.base_color[:3]), material.base_color[3]], np.float32)
    if pixels is None or uvs is None:
        return np.tile(factor, (count, 1))
    return looked_up(pixels, material.maps["base_color"], uvs) * factor


def _srgb(linear: float) -> float:
    return 12.92 * linear if linear <= 0.0031308 else float(1.055 * linear ** (1 / 2.4) - 0.055)


def _wrapped(index: NDArray[np.int64], size: int, mode: str) -> NDArray[np.int64]:
    if mode == "clamp":
        return np.clip(index, 0, size - 1)
    if mode == "mirror":
        index = index % (2 * size)
        return np.minimum(index, 2 * size - 1 - index)
    return index % size
