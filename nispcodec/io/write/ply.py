"""Binary PLY: vertices with texture coordinates or colors; no materials."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.vertices import origin, split_vertices


def ply_bytes(mesh: TexturedMesh, colors: Float32Array | None = None) -> bytes:
    """The mesh as the bytes of a binary little-endian PLY file.

    A seam's vertices are doubled for their UVs s, t; colors (n, 4), sRGB-encoded RGBA of each
    position, become red, green, blue, alpha. Coordinates are float64 when the mesh is far from the
    origin, else float32.
    """
    vertices = split_vertices(mesh, np.arange(len(mesh.faces)))
    kind = "<f8" if origin(mesh).any() else "<f4"
    fields = [(name, kind) for name in ("x", "y", "z")]
    values = list(vertices.positions.T)
    if colors is None:
        fields += [("s", "<f4"), ("t", "<f4")]
        values += list(vertices.uvs.T)
    else:
        fields += [(name, "u1") for name in ("red", "green", "blue", "alpha")]
        values += list(np.rint(colors[vertices.sources] * 255).T)
    rows = np.empty(len(vertices.positions), fields)
    for (name, _), column in zip(fields, values, strict=True):
        rows[name] = column
    faces = np.empty(len(vertices.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, vertices.faces
    return _header(fields, len(rows), len(faces)) + rows.tobytes() + faces.tobytes()


def _header(fields: list[tuple[str, str]], vertices: int, faces: int) -> bytes:
    types = {"<f4": "float", "<f8": "double", "u1": "uchar"}
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {vertices}",
        *(f"property {types[kind]} {name}" for name, kind in fields),
        f"element face {faces}",
        "property list uchar int vertex_indices",
        "end_header\n",
    ]
    return "\n".join(lines).encode()
