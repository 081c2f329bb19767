"""Images of the sample asset: a painted glaze, and wood with a normal map."""

from __future__ import annotations

import io

import numpy as np
import PIL.Image

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Texture

SIZE = 512
CREAM, COBALT, RUST = (0.93, 0.88, 0.78), (0.13, 0.24, 0.5), (0.68, 0.33, 0.18)


def glaze_texture() -> Texture:
    """The mug's base color: cream with painted bands on the wall, a blue handle below."""
    u, v = _grid()
    picture = np.array(CREAM) * (0.97 + 0.03 * _speckle(u, v)[..., None])
    # The wall spans u 0.02 to 0.98 and v 0.5 to 0.98; whole waves close at the seam.
    around, up = (u - 0.02) / 0.96, (v - 0.5) / 0.48
    wave = 0.05 * np.sin(2 * np.pi * 6 * around)
    picture = _paint(picture, COBALT, np.abs(up - 0.66 - wave) - 0.035)
    picture = _paint(picture, COBALT, np.abs(up - 0.66 + wave) - 0.012)
    dots = np.hypot(((12 * around) % 1 - 0.5) / 12 * 2.3, up - 0.48) - 0.022
    picture = _paint(picture, RUST, dots)
    picture = _paint(picture, RUST, np.maximum(up - 0.33, 0.02 - up))
    picture = _paint(picture, CREAM, np.abs(up - 0.27 - 0.2 * wave) - 0.01)
    handle = np.maximum.reduce([v - 0.185, u - 0.62])
    picture = _paint(picture, COBALT, handle)
    return _png("mug_color.png", picture)


def wood_textures() -> tuple[Texture, Texture]:
    """The saucer's base color and normal map: a plank cut across its rings."""
    u, v = _grid()
    bent = u + 0.03 * np.sin(2 * np.pi * (v * 1.3 + 0.2)) + 0.012 * np.sin(2 * np.pi * 3.1 * v)
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * 15 * (bent + 0.05 * bent**2))
    fibres = _speckle(8 * u, 0.4 * v)
    grain = 0.75 * rings**2 + 0.25 * fibres
    light, dark = np.array((0.76, 0.56, 0.36)), np.array((0.47, 0.29, 0.16))
    color = light + (dark - light) * grain[..., None]
    return _png("saucer_color.png", color), _png("saucer_normal.png", _normals(grain, 0.002))


def _grid() -> tuple[Float64Array, Float64Array]:
    """u and v of the texel centers, top row first, v upwards."""
    centers = (np.arange(SIZE) + 0.5) / SIZE
    u, v = np.meshgrid(centers, centers[::-1])
    return u, v


def _paint(
    picture: Float64Array, color: tuple[float, float, float], distance: Float64Array
) -> Float64Array:
    """Cover where `distance` (in v) is negative, with an edge two texels wide."""
    cover = np.clip(0.5 - distance * SIZE / 4, 0, 1)[..., None]
    painted: Float64Array = picture + (np.array(color) - picture) * cover
    return painted


def _speckle(u: Float64Array, v: Float64Array) -> Float64Array:
    """Smooth noise in [0, 1]: a sum of waves of random direction."""
    generator = np.random.default_rng(7)
    waves = generator.normal(0, 90, (24, 2))
    phases = generator.uniform(0, 2 * np.pi, 24)
    total = sum(np.sin(a * u + b * v + c) for (a, b), c in zip(waves, phases, strict=True))
    noise: Float64Array = np.clip(0.5 + total / 12, 0, 1)
    return noise


def _normals(height: Float64Array, depth: float) -> Float64Array:
    """Tangent-space normals in [0, 1] of a height field `depth` high (in UV); +y is +v."""
    down, right = np.gradient(height * depth * SIZE)
    normal = np.stack([-right, down, np.ones_like(height)], axis=-1)
    unit: Float64Array = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return 0.5 + 0.5 * unit


def _png(name: str, picture: Float64Array) -> Texture:
    buffer = io.BytesIO()
    pixels = np.round(np.clip(picture, 0, 1) * 255).astype(np.uint8)
    PIL.Image.fromarray(pixels).save(buffer, "PNG")
    return Texture(name, buffer.getvalue(), "image/png")
