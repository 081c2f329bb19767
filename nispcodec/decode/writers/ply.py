"""Binary PLY: vertices with texture coordinates s, t; no materials."""

from __future__ import annotations

import numpy as np

from nispcodec.asset import TexturedMesh
from nispcodec.decode.writers.vertices import split_vertices


def ply_bytes(mesh: TexturedMesh) -> bytes:
    """The mesh as the bytes of a binary little-endian PLY file; a seam's vertices are doubled."""
    vertices = split_vertices(mesh, np.arange(len(mesh.faces)))
    rows = np.column_stack([vertices.positions, vertices.uvs]).astype("<f4")
    faces = np.empty(len(vertices.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, vertices.faces
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(rows)}",
        *(f"property float {name}" for name in ("x", "y", "z", "s", "t")),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header\n",
    ]
    return "\n".join(header).encode() + rows.tobytes() + faces.tobytes()
