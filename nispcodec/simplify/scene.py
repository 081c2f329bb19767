"""Meshes with their copies as one mesh, to be measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.mesh_part import Placement
from nispcodec.core.placing import placed_points


def scene(meshes: Sequence[tuple[TexturedMesh, tuple[Placement, ...]]]) -> TexturedMesh:
    """Every copy of every mesh (normalized frame), in the materials of the mesh."""
    if len(meshes) == 1 and meshes[0][1] == (Placement(),):
        return meshes[0][0]
    copies = [placed(mesh, placement) for mesh, placements in meshes for placement in placements]
    most = max((copy.materials for copy in copies), key=len)
    positions = np.cumsum([0, *(len(copy.positions) for copy in copies)])
    uvs = np.cumsum([0, *(len(copy.uvs) for copy in copies)])
    return TexturedMesh(
        positions=np.concatenate([copy.positions for copy in copies]),
        faces=_one([copy.faces + at for copy, at in zip(copies, positions, strict=False)]),
        uvs=np.concatenate([copy.uvs for copy in copies]),
        uv_faces=_one(
            [
                np.where(copy.uv_faces < 0, -1, copy.uv_faces + at)
                for copy, at in zip(copies, uvs, strict=False)
            ]
        ),
        face_materials=_one([copy.face_materials for copy in copies]),
        materials=most,
    )


def placed(mesh: TexturedMesh, placement: Placement) -> TexturedMesh:
    """One copy of a mesh. Where it is mirrored, faces are wound so that they look outwards."""
    order = [0, 2, 1] if placement.mirrored else [0, 1, 2]
    return replace(
        mesh,
        positions=placed_points(placement, mesh.positions),
        faces=mesh.faces[:, order],
        uvs=mesh.uvs * placement.uv_scale + placement.uv_offset,
        uv_faces=mesh.uv_faces[:, order],
    )


def _one(arrays: Sequence[Int32Array]) -> Int32Array:
    return np.concatenate(arrays).astype(np.int32)
