"""`.nisp` in every preset that the encoder has, but for the paper's, and fitted to sizes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import nispcodec
from benchmarks.assets.source import SEED, Source
from benchmarks.codecs import Setting
from nispcodec.core.asset import TexturedMesh
from nispcodec.encode.config import PRESETS
from nispcodec.extract.meshing import default_resolution
from nispcodec.format import pack, unpack
from nispcodec.model import NispModel

PAPER, SLOW = "paper", "best"
# Bytes: with these a curve has the five points that a Bjontegaard-delta rate wants.
SIZES = (5_000, 10_000, 20_000)


def settings(source: Source, quick: bool) -> list[Setting]:
    """The presets, and the default one fitted to sizes; quick leaves out what is slow."""
    left_out = {PAPER, SLOW} if quick else {PAPER}
    presets: list[Setting] = [{"preset": name} for name in PRESETS if name not in left_out]
    default = nispcodec.EncodeConfig().preset
    sizes: list[Setting] = [{"preset": default, "target_size": size} for size in SIZES]
    return presets if quick else presets + sizes


def encode(source: Source, setting: Setting) -> bytes:
    """Networks and tables without textures, which all codecs have in common."""
    return encoded(source, setting)


def encoded(source: Source, options: Mapping[str, Any]) -> bytes:
    """The same with any of the options of `EncodeConfig`."""
    config = nispcodec.EncodeConfig(seed=SEED, textures=False, **options)
    return pack(nispcodec.encode(source.mesh, config).document)


def decode(data: bytes, source: Source) -> TexturedMesh:
    """The mesh at the default resolution, all of it: errors are to be the codec's alone."""
    model = NispModel(unpack(data))
    field = model.document.field
    cells = default_resolution(field.sdf, field.half_thickness) if field else None
    mesh = model.to_mesh(cells)
    return replace(mesh, materials=source.mesh.materials, textures=source.mesh.textures)
