"""Binary PLY: vertices with texture coordinates or colors, and images by name as MeshLab has it."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.io.write.images_beside import ImagesBeside
from nispcodec.io.write.vertices import Vertices, origin, shading_normals, split_vertices

_TYPES = {"<f4": "float", "<f8": "double", "u1": "uchar", "<i4": "int"}


def ply_files(
    mesh: TexturedMesh, stem: str, images: ImagesBeside, colors: Float32Array | None = None
) -> dict[str, bytes]:
    """File name -> bytes of STEM.ply, binary little-endian, and `images` for each base color.

    A seam's vertices are doubled for their UVs s, t; those of creases for normals nx, ny, nz.
    Colors (n, 4), sRGB-encoded RGBA of each
    position, become red, green, blue, alpha. Coordinates are float64 when the mesh is far from the
    origin, else float32. `texnumber` of a face is its image, -1 where it shows none.
    """
    maps = [each.maps.get("base_color") for each in mesh.materials]
    used = sorted({each.texture for each in maps if each is not None})
    numbers = np.array([-1 if each is None else used.index(each.texture) for each in maps], "<i4")
    shown = np.where(mesh.has_uv, numbers[mesh.face_materials], -1).astype("<i4")
    vertices = split_vertices(mesh, np.arange(len(mesh.faces)), shading_normals(mesh))
    rows = _vertex_rows(mesh, vertices, colors)
    faces = _face_rows(vertices, shown if used else None)
    body = (
        _header(rows, faces, [images.names[each] for each in used])
        + rows.tobytes()
        + faces.tobytes()
    )
    return images.files(mesh, used) | {f"{stem}.ply": body}


def _vertex_rows(mesh: TexturedMesh, vertices: Vertices, colors: Float32Array | None) -> AnyArray:
    kind = "<f8" if origin(mesh).any() else "<f4"
    fields = [(name, kind) for name in ("x", "y", "z")]
    values = list(vertices.positions.T)
    if colors is None:
        fields += [("s", "<f4"), ("t", "<f4")]
        values += list(vertices.uvs.T)
    else:
        fields += [(name, "u1") for name in ("red", "green", "blue", "alpha")]
        values += list(np.rint(colors[vertices.sources] * 255).T)
    fields += [(name, "<f4") for name in ("nx", "ny", "nz")]
    values += list(vertices.normals.T)
    rows = np.empty(len(vertices.positions), fields)
    for (name, _), column in zip(fields, values, strict=True):
        rows[name] = column
    return rows


def _face_rows(vertices: Vertices, images: Int32Array | None) -> AnyArray:
    """A count of 3, the corners, and the image of each face where there are any."""
    fields: list[tuple[str, str] | tuple[str, str, int]] = [("count", "u1"), ("corners", "<i4", 3)]
    rows = np.empty(
        len(vertices.faces), [*fields, ("texnumber", "<i4")] if images is not None else fields
    )
    rows["count"], rows["corners"] = 3, vertices.faces
    if images is not None:
        rows["texnumber"] = images
    return rows


def _header(rows: AnyArray, faces: AnyArray, images: list[str]) -> bytes:
    columns = [(name, rows.dtype[name].str.lstrip("|")) for name in rows.dtype.names or ()]
    lines = [
        "ply",
        "format binary_little_endian 1.0",
        *(f"comment TextureFile {image}" for image in images),
        f"element vertex {len(rows)}",
        *(f"property {_TYPES[kind]} {name}" for name, kind in columns),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        *(["property int texnumber"] if images else []),
        "end_header\n",
    ]
    return "\n".join(lines).encode(errors="surrogateescape")
