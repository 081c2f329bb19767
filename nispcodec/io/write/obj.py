"""OBJ with its MTL and images: files named after the output, so that no other file is touched."""

from __future__ import annotations

import math

import numpy as np

from nispcodec.core.arrays import AnyArray, Float32Array
from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.slots import BY_NAME
from nispcodec.io.write.images_beside import ImagesBeside
from nispcodec.io.write.names import plain, unique
from nispcodec.io.write.vertices import shading_normals


def obj_files(
    mesh: TexturedMesh, stem: str, images: ImagesBeside, colors: Float32Array | None = None
) -> dict[str, bytes]:
    """File name -> bytes of STEM.obj, STEM.mtl and `images` for every texture in use.

    Colors (n, 4), sRGB-encoded, stand behind the positions, as many tools read them, without
    alpha; then there is no MTL. Occlusion and metallic-roughness maps are left out, and images that
    nothing else uses with them.
    """
    if colors is not None:
        return {f"{stem}.obj": _colored_obj(mesh, colors).encode(errors="surrogateescape")}
    names = unique([plain(material.name) for material in mesh.materials])
    slots = [slots for material in mesh.materials for slots in material.maps.items()]
    wanted = {used.texture for slot, used in slots if BY_NAME[slot].mtl_write}
    materials = zip(mesh.materials, names, strict=True)
    mtl = "\n".join(_mtl(material, name, images.names) for material, name in materials)
    return images.files(mesh, sorted(wanted)) | {
        f"{stem}.mtl": mtl.encode(errors="surrogateescape"),
        f"{stem}.obj": _obj(mesh, f"{stem}.mtl", names).encode(errors="surrogateescape"),
    }


def _obj(mesh: TexturedMesh, library: str, names: list[str]) -> str:
    parts = [f"mtllib {library}\no {plain(mesh.name)}\n"]
    parts.append(_rows(f"v {_decimals(mesh)}\n", mesh.positions))
    parts.append(_rows("vt %.7g %.7g\n", mesh.uvs))
    normals = shading_normals(mesh)
    parts.append(_rows("vn %.4g %.4g %.4g\n", normals.rows))
    if mesh.creases is None:
        # For readers that pass over normals; a smoothing group has no words for single creases.
        parts.append("s 1\n")
    dressed: list[AnyArray] = [mesh.faces, mesh.uv_faces, normals.faces]
    for material in np.unique(mesh.face_materials).tolist():
        parts.append(f"usemtl {names[material]}\n")
        chosen = mesh.face_materials == material
        with_uv, without = chosen & mesh.has_uv, chosen & ~mesh.has_uv
        parts.append(_faces("%d/%d/%d", [each[with_uv] for each in dressed]))
        parts.append(_faces("%d//%d", [each[without] for each in dressed[::2]]))
    return "".join(parts)


def _faces(corner: str, indices: list[AnyArray]) -> str:
    """Lines of three corners each, of indices (m, 3) from 0."""
    return _rows(f"f {corner} {corner} {corner}\n", np.stack(indices, axis=2) + 1)


def _colored_obj(mesh: TexturedMesh, colors: Float32Array) -> str:
    vertices = np.hstack([mesh.positions, colors[:, :3]])
    return (
        f"o {plain(mesh.name)}\n"
        + _rows(f"v {_decimals(mesh)} %.4g %.4g %.4g\n", vertices)
        + _rows("f %d %d %d\n", mesh.faces + 1)
    )


def _decimals(mesh: TexturedMesh) -> str:
    """The pattern of a position: seven digits of the mesh's extent, wherever it lies."""
    extent = float(np.ptp(mesh.positions, axis=0).max()) or 1.0
    return " ".join([f"%.{max(0, 7 - math.floor(math.log10(extent)))}f"] * 3)


def _rows(pattern: str, values: AnyArray) -> str:
    return (pattern * len(values)) % tuple(values.ravel().tolist())


def _mtl(material: Material, name: str, images: list[str]) -> str:
    lines = [
        f"newmtl {name}",
        "Kd {:.6g} {:.6g} {:.6g}".format(*material.base_color[:3]),
        f"d {material.base_color[3]:.6g}",
        f"Pm {material.metallic:.6g}",
        f"Pr {material.roughness:.6g}",
        "Ke {:.6g} {:.6g} {:.6g}".format(*material.emissive),
    ]
    for slot, used in material.maps.items():
        lines += [_map(keyword, used, images) for keyword in BY_NAME[slot].mtl_write]
    return "\n".join(lines) + "\n"


def _map(keyword: str, used: TextureMap, images: list[str]) -> str:
    options = " -clamp on" if used.wrap == ("clamp", "clamp") else ""
    if keyword in BY_NAME["normal"].mtl_write and used.strength != 1:
        options += f" -bm {used.strength:.6g}"
    return f"{keyword}{options} {images[used.texture]}"
