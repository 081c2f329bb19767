"""Texture padding: what lies between the charts of the atlas takes the colors beside it.

The seams and UVs of a decoded surface are a little off: along a seam it shows some of what lies
between the charts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.extras import require
from nispcodec.core.raster import coverage, padded
from nispcodec.core.texture import data_maps, encode_image, image_bytes

ROUNDING = 1e-6
"""UVs that leave the image by less than this count as inside."""


def with_padded_textures(mesh: TexturedMesh, quality: int) -> tuple[Texture, ...]:
    """The mesh's textures with the nearest used texel's color where no face lies.

    Formats and names stay; `quality`, 1 to 100, is for lossy formats. An image that no face uses,
    or that some face leaves or repeats, stays as it is. Raises MeshError for a texture that
    does not decode, NispError without the extra `encode`.
    """
    require("scipy", extra="encode", what_for="padding textures")
    return tuple(_padded(mesh, number, quality) for number in range(len(mesh.textures)))


def _padded(mesh: TexturedMesh, number: int, quality: int) -> Texture:
    texture = mesh.textures[number]
    pixels = image_bytes(texture)
    covered = used_texels(mesh, number, *pixels.shape[:2])
    if covered is None:
        return texture
    is_data = number in data_maps(mesh.materials)
    data = encode_image(padded(pixels, covered), texture.mime.split("/")[1], quality, is_data)
    return replace(texture, data=data)


def used_texels(mesh: TexturedMesh, number: int, height: int, width: int) -> BoolArray | None:
    """(height, width): which texels of an image faces show; None where none is to be padded.

    That is an image that no face uses, one that is used everywhere, and one that some face leaves
    or repeats.
    """
    uvs, repeated = _uvs(mesh, number)
    if not len(uvs) or uvs.min() < -ROUNDING or uvs.max() > 1 + repeated + ROUNDING:
        return None
    covered = coverage(uvs, height, width)
    if uvs.max() > 1 + ROUNDING:
        for shift in ([1.0, 0.0], [0.0, 1.0], [1.0, 1.0]):
            covered |= coverage(uvs - shift, height, width)
    return None if covered.all() else covered


def _uvs(mesh: TexturedMesh, number: int) -> tuple[Float64Array, bool]:
    """(f, 3, 2): UVs of the faces that show the image; whether it repeats: it begins in [0, 1]."""
    uses = [[m for m in each.maps.values() if m.texture == number] for each in mesh.materials]
    shown = np.array([bool(each) for each in uses], np.bool_)
    uvs = mesh.corner_uvs[shown[mesh.face_materials] & mesh.has_uv]
    repeats = all(used.wrap == ("repeat", "repeat") for each in uses for used in each)
    if repeats:
        uvs = uvs - np.floor(uvs.min(axis=1, keepdims=True) + ROUNDING)
    return uvs, repeats
