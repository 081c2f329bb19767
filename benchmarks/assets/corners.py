"""A mesh with one vertex for each distinct corner, as glTF and Draco want it, and back."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from benchmarks.assets.source import Source
from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, IntArray, Uint32Array
from nispcodec.core.asset import TexturedMesh


@dataclass(frozen=True)
class Corners:
    """positions (n, 3) and uvs (n, 2) float64, materials (n,) int32, faces (m, 3) into these."""

    positions: Float64Array
    uvs: Float64Array
    materials: Int32Array
    faces: Uint32Array

    def only(self, faces: IntArray) -> Corners:
        """Other faces (k, 3) over the same vertices, and of those only the ones in use."""
        used, renumbered = np.unique(faces, return_inverse=True)
        corners = renumbered.reshape(-1, 3).astype(np.uint32)
        return Corners(self.positions[used], self.uvs[used], self.materials[used], corners)


def corners_of(mesh: TexturedMesh, chosen: BoolArray | None = None) -> Corners:
    """The (chosen) faces of a mesh; a corner without UV gets (0, 0)."""
    faces = np.flatnonzero(np.ones(len(mesh.faces), np.bool_) if chosen is None else chosen)
    materials = np.repeat(mesh.face_materials[faces], 3)
    keys = [mesh.faces[faces].ravel(), mesh.uv_faces[faces].ravel(), materials]
    rows, corners = np.unique(np.stack(keys, axis=1), axis=0, return_inverse=True)
    uvs = np.vstack([mesh.uvs, np.zeros((1, 2))])
    return Corners(
        mesh.positions[rows[:, 0]],
        uvs[rows[:, 1]],
        rows[:, 2],
        corners.reshape(-1, 3).astype(np.uint32),
    )


def mesh_of(source: Source, corners: Corners) -> TexturedMesh:
    """A mesh of these corners with the materials and textures of the source."""
    faces = corners.faces.astype(np.int32)
    return replace(
        source.mesh,
        positions=corners.positions,
        faces=faces,
        uvs=corners.uvs,
        uv_faces=faces,
        face_materials=corners.materials[faces[:, 0]],
        creases=None,
        warnings=(),
    )
