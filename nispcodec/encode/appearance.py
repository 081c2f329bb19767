"""The materials and images of a file, as its user wants them."""

from __future__ import annotations

from dataclasses import replace

from nispcodec.core.asset import Material, Texture, TexturedMesh
from nispcodec.core.progress import Listener, Progress
from nispcodec.core.texture import data_maps, reencode
from nispcodec.edit.texture_padding import with_padded_textures
from nispcodec.encode.compact_images import compact_textures
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.total_config import CompactConfig


def appearance(
    mesh: TexturedMesh, config: EncodeConfig, compact: CompactConfig, progress: Listener
) -> tuple[tuple[Material, ...], tuple[Texture, ...]]:
    """Materials and textures: left out, padded, re-encoded, or as they are."""
    if not config.textures:
        return tuple(replace(material, maps={}) for material in mesh.materials), ()
    progress(Progress(stage="textures"))
    textures, quality = mesh.textures, config.texture_quality
    if config.texture_format == "auto":
        return mesh.materials, compact_textures(mesh, quality, compact)
    if config.pad_textures:
        textures = with_padded_textures(mesh, 100 if config.texture_format else quality)
    if config.texture_format is not None:
        textures = reencode(textures, config.texture_format, quality, data_maps(mesh.materials))
    return mesh.materials, textures
