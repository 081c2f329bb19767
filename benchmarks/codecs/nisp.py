"""`.nisp` in every preset that the encoder has, but for the paper's."""

from __future__ import annotations

from dataclasses import replace

import nispcodec
from benchmarks.codecs import Setting
from benchmarks.source import SEED, Source
from nispcodec.asset import TexturedMesh
from nispcodec.decode.model import NispModel
from nispcodec.encoder import PRESETS
from nispcodec.format import pack, unpack

PAPER, SLOW = "paper", "best"


def settings(source: Source, quick: bool) -> list[Setting]:
    """The presets; quick leaves out the slow one."""
    left_out = {PAPER, SLOW} if quick else {PAPER}
    return [{"preset": name} for name in PRESETS if name not in left_out]


def encode(source: Source, setting: Setting) -> bytes:
    """Networks and tables without textures, which all codecs have in common."""
    config = nispcodec.EncodeConfig(preset=str(setting["preset"]), seed=SEED, textures=False)
    return pack(nispcodec.encode(source.mesh, config).document)


def decode(data: bytes, source: Source) -> TexturedMesh:
    """The mesh at the default resolution."""
    mesh = NispModel(unpack(data)).to_mesh()
    return replace(mesh, materials=source.mesh.materials, textures=source.mesh.textures)
