"""How far the base colors of paired points differ."""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.texture import base_colors
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.psnr import psnr
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at


def color_at(surface: Surface, points: SurfacePoints) -> Float32Array:
    """(n, 4) float32 in [0, 1]: sRGB-encoded base color and linear alpha at points of a surface.

    Faces without UV show their material's factor alone. Raises MeshError for a texture that does
    not decode.
    """
    mesh, faces = surface.mesh, points.faces
    owners, has_uv = mesh.face_materials[faces], mesh.has_uv[faces]
    return base_colors(mesh.materials, mesh.textures, owners, has_uv, uv_at(surface, points))


def color_psnr(original: Surface, decoded: Surface, directions: Iterable[Matches]) -> float:
    """PSNR in dB of the RGB base colors of all pairs, sRGB-encoded, peak 1.

    Raises MeshError for a texture that does not decode.
    """
    matches = reduce(Matches.__add__, directions)
    first = color_at(original, matches.original)[:, :3].astype(np.float64)
    second = color_at(decoded, matches.decoded)[:, :3]
    return psnr(float(((second - first) ** 2).mean()), 1.0)
