"""Binary STL: triangles and their normals, nothing else."""

from __future__ import annotations

import struct

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError


def stl_bytes(mesh: TexturedMesh, colors: Float32Array | None = None) -> bytes:
    """The mesh as the bytes of a binary STL file; UVs and materials are left out.

    Raises MeshError for colors.
    """
    if colors is not None:
        raise MeshError("STL holds no colors: expected .glb, .gltf, .obj, .ply or .usdz")
    a, b, c = mesh.corners.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    triangles = np.zeros(len(mesh.faces), [("rows", "<f4", (4, 3)), ("attribute", "<u2")])
    triangles["rows"][:, 0] = np.divide(normals, lengths, out=normals, where=lengths > 0)
    triangles["rows"][:, 1:] = mesh.corners
    return struct.pack("<80sI", b"nispcodec", len(triangles)) + triangles.tobytes()
