"""Small things to look at, with known looks."""

from __future__ import annotations

import dataclasses
from io import BytesIO

import numpy as np
import PIL.Image

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.document import Frame
from tests.metrics.shapes import plane

UNIT = Frame((0.5, 0.5, 0.0), 1.0)
"""Puts the square of `plane` into the middle of the normalized frame."""


def texture(pixels: object, name: str = "t.png") -> Texture:
    file = BytesIO()
    PIL.Image.fromarray(np.array(pixels, dtype=np.uint8)).save(file, "PNG")
    return Texture(name, file.getvalue(), "image/png")


def with_maps(mesh: TexturedMesh, filter: str = "nearest", **maps: object) -> TexturedMesh:
    """The mesh with one material whose slots show the given pixels."""
    textures = tuple(texture(pixels, f"{slot}.png") for slot, pixels in maps.items())
    used = {slot: TextureMap(i, ("clamp", "clamp"), filter) for i, slot in enumerate(maps)}
    return dataclasses.replace(mesh, materials=(Material(maps=used),), textures=textures)


def square(filter: str = "nearest", **maps: object) -> TexturedMesh:
    """The unit square facing +z, with maps of pixels."""
    return with_maps(plane(), filter, **maps)
