"""Textures for pictures: linear light, smaller copies of each image, filtered over a footprint."""

from __future__ import annotations

from threading import Lock

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, Texture
from nispcodec.core.slots import BY_NAME
from nispcodec.core.texture import decode_image, sample_texture, srgb_to_linear
from nispcodec.render.fragments import Fragments


class Maps:
    """The textures of an asset, ready for lookups; images are decoded when they are first used."""

    def __init__(self, textures: tuple[Texture, ...]) -> None:
        self._textures = textures
        self._pyramids: dict[tuple[int, bool], list[Float32Array]] = {}
        self._one_at_a_time = Lock()

    def look_up(
        self, material: Material, slot: str, points: Fragments, footprints: Float32Array
    ) -> Float32Array | None:
        """Texels (n, 4) float32 of a slot, linear, or None when the material has none there.

        `footprints` (n,) is the length in the normalized frame that one sample of the picture
        spans: the image is taken at the size at which a texel covers as much (trilinear filtering,
        Williams 1983). Raises MeshError for a texture that does not decode.
        """
        used = material.maps.get(slot)
        if used is None:
            return None
        pyramid = self._pyramid(used.texture, BY_NAME[slot].srgb)
        if used.filter == "nearest":
            return sample_texture(pyramid[0], points.uvs, used.wrap, used.filter)
        levels = _levels(points, footprints, pyramid[0].shape, len(pyramid))
        return _trilinear(pyramid, points.uvs, levels, used.wrap)

    def _pyramid(self, texture: int, srgb: bool) -> list[Float32Array]:
        key = texture, srgb
        with self._one_at_a_time:
            if key not in self._pyramids:
                image = decode_image(self._textures[texture])
                if srgb:
                    image = np.dstack([srgb_to_linear(image[..., :3]), image[..., 3]])
                self._pyramids[key] = _pyramid(image)
            return self._pyramids[key]


def _pyramid(image: Float32Array) -> list[Float32Array]:
    """The image and its copies, each half as large, down to one texel."""
    from PIL.Image import Resampling, fromarray

    levels = [image]
    while max(levels[-1].shape[:2]) > 1:
        height, width = (max(1, size // 2) for size in levels[-1].shape[:2])
        channels = [
            np.asarray(fromarray(channel).resize((width, height), Resampling.BOX))
            for channel in np.moveaxis(levels[-1], 2, 0)
        ]
        levels.append(np.stack(channels, axis=2))
    return levels


def _levels(
    points: Fragments, footprints: Float32Array, shape: tuple[int, ...], count: int
) -> Float32Array:
    """At which level (n,), between the copies, a texel has the area of the footprint."""
    height, width = shape[:2]
    u, v = points.jacobians[:, 0], points.jacobians[:, 1]
    stretch = np.linalg.norm(np.cross(u, v), axis=1) * (width * height) * footprints**2
    return np.clip(np.log2(np.maximum(stretch, 1e-12)) / 2, 0, count - 1).astype(np.float32)


def _trilinear(
    pyramid: list[Float32Array], uvs: Float32Array, levels: Float32Array, wrap: tuple[str, str]
) -> Float32Array:
    lower = np.floor(levels).astype(np.int32)
    texels = np.empty((len(uvs), pyramid[0].shape[2]), np.float32)
    for level in np.unique(lower).tolist():
        chosen = lower == level
        fine = sample_texture(pyramid[level], uvs[chosen], wrap)
        coarse = sample_texture(pyramid[min(level + 1, len(pyramid) - 1)], uvs[chosen], wrap)
        texels[chosen] = fine + (coarse - fine) * (levels[chosen] - level)[:, None]
    return texels
