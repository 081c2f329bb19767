"""An asset's images in few bytes: AVIF of padded pixels; the file itself where that is smaller."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Uint8Array
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.raster import padded, padded_smoothly
from nispcodec.core.texture import (
    data_maps,
    encode_image,
    encoded_texture,
    image_bytes,
    named_apart,
)
from nispcodec.edit.texture_padding import used_texels
from nispcodec.encode.total_config import CompactConfig

LEAST, MOST = 1, 100
"""Quality of an image."""


class CompactImage:
    """One image of an asset, at any quality; what was coded once is kept.

    All channels are as sharp. Raises MeshError for a texture that does not decode.
    """

    def __init__(
        self, mesh: TexturedMesh, number: int, config: CompactConfig = CompactConfig()
    ) -> None:
        self._config = config
        self.original = mesh.textures[number]
        self.is_data = number in data_maps(mesh.materials)
        self._pixels = image_bytes(self.original)
        self._used = used_texels(mesh, number, *self._pixels.shape[:2])
        self._padded: Uint8Array | None = None
        self._coded: dict[tuple[int, str], Texture] = {}

    def at(self, quality: int, tune: str | None = None) -> Texture:
        """As AVIF, or as it was where that takes no more bytes; `tune` other than is usual."""
        key = quality, tune or self._config.tune
        if key not in self._coded:
            found = encoded_texture(
                self.original.name, self.padded_pixels(), "avif", quality, True, key[1]
            )
            smaller = len(found.data) < len(self.original.data)
            self._coded[key] = found if smaller else self.original
        return self._coded[key]

    def near(self, quality: int) -> Texture:
        """As `at`, but data of no error larger than `most_error`, without loss if need be."""
        if not self.is_data:
            return self.at(quality)
        for finer in range(quality, MOST + 1, self._config.finer):
            if self._error(self.at(finer)) <= self._config.most_error:
                return self.at(finer)
        exact = encoded_texture(self.original.name, self._pixels, "webp", MOST, is_data=True)
        return min(exact, self.original, key=lambda each: len(each.data))

    def _error(self, coded: Texture) -> float:
        """Root of the mean square over the texels that are used."""
        used = slice(None) if self._used is None else self._used
        apart = (image_bytes(coded)[used].astype(np.float32) - self._pixels[used]) / 255
        return float(np.sqrt(np.square(apart).sum(axis=-1).mean()))

    def padded_pixels(self) -> Uint8Array:
        """The pixels padded in the way that takes fewer bytes: smooth colors, or the nearest."""
        if self._used is None:
            return self._pixels
        if self._padded is None:
            ways = [padded_smoothly(self._pixels, self._used), padded(self._pixels, self._used)]
            self._padded = min(ways, key=self._typical_bytes)
        return self._padded

    def _typical_bytes(self, pixels: Uint8Array) -> int:
        return len(encode_image(pixels, "avif", self._config.typical, True, self._config.tune))


def compact_images(
    mesh: TexturedMesh, config: CompactConfig = CompactConfig()
) -> list[CompactImage]:
    """The images of a mesh, to be coded. Raises MeshError for one that does not decode."""
    return [CompactImage(mesh, number, config) for number in range(len(mesh.textures))]


def compact_textures(
    mesh: TexturedMesh, quality: int, config: CompactConfig
) -> tuple[Texture, ...]:
    """The textures of a mesh at a quality of 1 to 100, data no further off than `config` says."""
    return named_apart([image.near(quality) for image in compact_images(mesh, config)])
