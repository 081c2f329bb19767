"""Which corners of a mesh are the same, and what hangs together: found once, for all that asks.

File formats split vertices (glTF), and numbers in a file say nothing: corners are welded where
positions, and UVs, are equal to the last bit.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import cell_ids, connected_faces, row_ids


@dataclass(frozen=True)
class Welding:
    """The welded corners of a mesh of m faces; all numbers count from 0 up.

    positions  (m, 3) int64: the same number for the same position
    corners    (m, 3) int64: the same number for the same position and UV on one patch
    patches    (m,) int32: faces that corners of one material connect share a number, those of one
               material without UV too; numbers rise with the first face of each
    """

    positions: Int64Array
    corners: Int64Array
    patches: Int32Array


def welded(mesh: TexturedMesh) -> Welding:
    """Weld the corners of a mesh."""
    positions = row_ids(mesh.positions)[mesh.faces]
    has_uv = mesh.has_uv[:, None]
    uvs = np.full(mesh.faces.shape, -1, dtype=np.int64)
    if len(mesh.uvs):
        uvs = np.where(has_uv, row_ids(mesh.uvs)[mesh.uv_faces], -1)
    connecting = np.where(has_uv, positions, -1)
    patches = connected_faces(cell_ids(mesh.face_materials[:, None], connecting, uvs))
    corners = cell_ids(patches[:, None], positions, uvs)
    return Welding(positions, corners, patches)
