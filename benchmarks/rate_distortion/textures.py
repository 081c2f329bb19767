"""The texture codecs, which all mesh codecs have in common: bytes against what is lost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from benchmarks.assets.source import Source
from benchmarks.codecs import Setting
from benchmarks.measuring.isolated import WorkFailed, isolated
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import Record
from nispcodec.core.asset import Texture, TexturedMesh
from nispcodec.core.texture import data_maps, decode_image, reencode
from nispcodec.metrics.psnr import psnr

TEXTURES = "textures"
ORIGINAL = "original"
SETTINGS: Sequence[Setting] = (
    {"format": ORIGINAL},
    {"format": "webp", "quality": 90},
    {"format": "webp", "quality": 75},
    {"format": "avif", "quality": 75},
    {"format": "avif", "quality": 60},
)


def measured(source: Source, setting: Setting) -> tuple[Record, bytes]:
    """The images of an asset in one format: bytes of all, PSNR in dB over all RGB values."""
    record: Record = {"asset": source.name, "codec": TEXTURES, "setting": setting}
    record["commit"] = commit()
    before = source.mesh.textures
    try:
        after, cost = isolated(lambda: coded(source.mesh, setting))
        record |= {"bytes": sum(len(texture.data) for texture in after), "encode": asdict(cost)}
        _, cost = isolated(lambda: sum(decode_image(texture).size for texture in after))
        quality, _ = isolated(lambda: picture_psnr(before, after))
        record |= {"decode": asdict(cost), "psnr": quality}
    except WorkFailed as why:
        record |= {"failure": str(why)}
    return record, b""


def coded(mesh: TexturedMesh, setting: Setting) -> Sequence[Texture]:
    """The images in the format of a setting, as `--texture-format` writes them."""
    if setting["format"] == ORIGINAL:
        return mesh.textures
    data = data_maps(mesh.materials)
    return reencode(mesh.textures, str(setting["format"]), int(setting["quality"]), data)


def picture_psnr(before: Sequence[Texture], after: Sequence[Texture]) -> float:
    """PSNR in dB over the RGB values of all images together, peak 1."""
    total, count = 0.0, 0
    for first, second in zip(before, after, strict=True):
        difference = decode_image(first)[..., :3] - decode_image(second)[..., :3]
        total += float(np.square(difference, dtype=np.float64).sum())
        count += difference.size
    return psnr(total / max(count, 1), 1.0)
