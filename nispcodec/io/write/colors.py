"""Meshes with a color at each vertex instead of textures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError


def untextured(mesh: TexturedMesh, colors: Float32Array) -> TexturedMesh:
    """The mesh without UVs and textures and with one plain material, ready to carry colors.

    colors (n, 4): RGBA in [0, 1] of each position, RGB sRGB-encoded. Raises MeshError for another
    shape.
    """
    if colors.shape != (len(mesh.positions), 4):
        raise MeshError(f"colors: expected shape ({len(mesh.positions)}, 4), found {colors.shape}")
    blended = bool((colors[:, 3] < 1).any())
    material = Material("vertex colors", alpha_mode="blend" if blended else "opaque")
    return replace(
        mesh,
        uvs=np.zeros((0, 2)),
        uv_faces=np.full_like(mesh.uv_faces, -1),
        face_materials=np.zeros_like(mesh.face_materials),
        materials=(material,),
        textures=(),
    )
