"""Draco with positions, UVs and materials in one buffer, level 10.

DracoPy's defaults would be unfair: level 1, and UVs as raw floats unless their bits are given. It
merges equal positions and UVs before coding, so that seams cost no second copy.
"""

from __future__ import annotations

from collections.abc import Sequence

import DracoPy
import numpy as np

from benchmarks.assets.corners import Corners, corners_of, mesh_of
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import TexturedMesh

LEVEL = 10
# The names with which Draco tells positions, UVs and others apart.
POSITION, UV, MATERIAL = 0, 3, 4
BITS: Sequence[tuple[int, int]] = (
    (8, 8), (9, 9), (10, 9), (10, 10), (11, 10), (11, 11), (12, 11), (12, 12), (14, 12),
)  # fmt: skip


def settings(source: Source, quick: bool) -> list[Setting]:
    """Bits of positions and of UVs."""
    return [{"qp": qp, "qt": qt} for qp, qt in (BITS[1::2] if quick else BITS)]


def encode(source: Source, setting: Setting) -> bytes:
    """The whole mesh."""
    return encode_corners(corners_of(source.mesh), setting)


def encode_corners(corners: Corners, setting: Setting) -> bytes:
    """Any mesh, with `qp` bits a coordinate and `qt` bits a texture coordinate."""
    materials = corners.materials.astype(np.uint8)[:, None]
    several = len(np.unique(materials)) > 1
    return DracoPy.encode(
        corners.positions.astype(np.float32),
        corners.faces,
        quantization_bits=int(setting["qp"]),
        compression_level=LEVEL,
        tex_coord=corners.uvs,
        tex_coord_quantization_bits=int(setting["qt"]),
        generic_attributes={0: materials} if several else None,
    )


def decode(data: bytes, source: Source) -> TexturedMesh:
    """The mesh in a buffer."""
    found = DracoPy.decode(data)
    parts: dict[int, AnyArray]
    parts = {part["attribute_type"]: part["data"] for part in found.attributes}
    materials = parts.get(MATERIAL, np.zeros((len(parts[POSITION]), 1), np.uint8))[:, 0]
    positions, uvs = (parts[part].astype(np.float64) for part in (POSITION, UV))
    return mesh_of(source, Corners(positions, uvs, materials.astype(np.int32), found.faces))
