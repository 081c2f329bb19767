"""Texture padding: what lies between the charts of the atlas takes the colors beside it.

The seams and UVs of a decoded surface are a little off: along a seam it shows some of what lies
between the charts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.extras import require
from nispcodec.core.raster import coverage, padded
from nispcodec.core.texture import data_maps, encode_image, image_bytes

ROUNDING = 1e-6
"""UVs that leave the image by less than this count as inside."""


def with_padded_textures(mesh: TexturedMesh, quality: int) -> tuple[Texture, ...]:
    """The mesh's textures with the nearest used texel's color where no face lies.

    Formats and names stay; `quality`, 1 to 100, is for lossy formats. An image that no face uses,
    or that some face uses across its border, stays as it is. Raises MeshError for a texture that
    does not decode, NispError without the extra `encode`.
    """
    require("scipy", extra="encode", what_for="padding textures")
    return tuple(_padded(mesh, number, quality) for number in range(len(mesh.textures)))


def _padded(mesh: TexturedMesh, number: int, quality: int) -> Texture:
    texture, uvs = mesh.textures[number], _uvs(mesh, number)
    if not len(uvs) or uvs.min() < -ROUNDING or uvs.max() > 1 + ROUNDING:
        return texture
    pixels = image_bytes(texture)
    image = padded(pixels, coverage(uvs, *pixels.shape[:2]))
    is_data = number in data_maps(mesh.materials)
    data = encode_image(image, texture.mime.split("/")[1], quality, is_data)
    return replace(texture, data=data)


def _uvs(mesh: TexturedMesh, number: int) -> Float64Array:
    """(f, 3, 2): UVs of the faces that show the image, where it repeats in its first repetition."""
    uses = [[m for m in each.maps.values() if m.texture == number] for each in mesh.materials]
    shown = np.array([bool(each) for each in uses], np.bool_)
    uvs = mesh.corner_uvs[shown[mesh.face_materials] & mesh.has_uv]
    if all(used.wrap == ("repeat", "repeat") for each in uses for used in each):
        uvs = uvs - np.floor(uvs.min(axis=1, keepdims=True) + ROUNDING)
    return uvs
