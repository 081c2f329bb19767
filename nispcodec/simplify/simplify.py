"""Fewer triangles: edges collapsed, then positions and UVs fitted to the source."""

from __future__ import annotations

from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.config import CollapseConfig, FitConfig
from nispcodec.simplify.position_fit import fitted_positions
from nispcodec.simplify.shading import shaded
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from nispcodec.simplify.uv_fit import fitted_uvs


def simplified(
    source: Source,
    faces: int,
    collapse: CollapseConfig = CollapseConfig(),
    fit: FitConfig = FitConfig(),
    seed: int = 0,
) -> Triangles:
    """About `faces` triangles that are near the source; the source's where it has no more.

    There are more where fewer cannot be had without losing notable bodies.
    """
    if faces >= len(source.triangles):
        return source.triangles
    fewer = collapsed(source.triangles, faces, collapse)
    placed = fitted_positions(source, fewer, fit, seed)
    return fitted_uvs(source, shaded(source, placed), fit, seed)
