"""How far the base colours of paired points differ."""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

import numpy as np

from nispcodec.asset import TexturedMesh
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.psnr import psnr
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at
from nispcodec.texture import Image, base_color, decode_image


def color_at(surface: Surface, points: SurfacePoints) -> Image:
    """(n, 4) float32: sRGB-encoded base colour and alpha at points of a surface.

    Faces without UV show their material's factor alone.
    """
    mesh, uvs = surface.mesh, uv_at(surface, points)
    textured = mesh.has_uv[points.faces]
    materials = mesh.face_materials[points.faces]
    colors = np.empty((len(uvs), 4), dtype=np.float32)
    for index in np.unique(materials).tolist():
        for has_uv in (True, False):
            chosen = (materials == index) & (textured == has_uv)
            image = base_color_image(mesh, index) if has_uv and chosen.any() else None
            colors[chosen] = base_color(mesh.materials[index], image, uvs[chosen])
    return colors


def base_color_image(mesh: TexturedMesh, material: int) -> Image | None:
    """The pixels of a material's base-colour map, None when it has none."""
    used = mesh.materials[material].maps.get("base_color")
    return None if used is None else decode_image(mesh.textures[used.texture])


def color_psnr(original: Surface, decoded: Surface, directions: Iterable[Matches]) -> float:
    """PSNR in dB of the RGB base colours of all pairs, sRGB-encoded, peak 1."""
    matches = reduce(Matches.__add__, directions)
    first = color_at(original, matches.original)[:, :3].astype(np.float64)
    second = color_at(decoded, matches.decoded)[:, :3]
    return psnr(float(((second - first) ** 2).mean()), 1.0)
