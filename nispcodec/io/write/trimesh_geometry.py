"""A textured mesh as the arguments of `trimesh.Trimesh`: one for each material, as in a GLB."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from nispcodec.core.arrays import IndexArray, Uint8Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.progress import warn
from nispcodec.core.slots import BY_NAME
from nispcodec.core.texture import distinct_names, image_bytes
from nispcodec.io.write.losses import trimesh_losses
from nispcodec.io.write.vertices import Normals, groups, shading_normals, split_vertices

if TYPE_CHECKING:
    import PIL.Image
    from trimesh.visual.material import PBRMaterial

Arguments = dict[str, Any]


def trimesh_arguments(mesh: TexturedMesh) -> dict[str, Arguments]:
    """Material's name -> the keyword arguments of `trimesh.Trimesh` for its faces.

    World frame, UVs with their origin bottom-left, vertices split where UVs and normals are.
    Images are decoded once, and shared. Names are made distinct. The mesh's warnings, and what
    trimesh has no place for, are warned of. Raises MeshError for an image that does not decode.
    """
    warn([*mesh.warnings, *(f"left out {what}" for what in trimesh_losses(mesh))])
    images = [_image(image_bytes(each)) for each in mesh.textures]
    normals = shading_normals(mesh)
    parts = list(groups(mesh))
    names = distinct_names([mesh.materials[material].name for material, _, _ in parts])
    return {
        name: _arguments(mesh, normals, faces, _pbr(mesh.materials[material], images, has_uv))
        for name, (material, has_uv, faces) in zip(names, parts, strict=True)
    }


def _arguments(
    mesh: TexturedMesh, normals: Normals, faces: IndexArray, material: PBRMaterial
) -> Arguments:
    from trimesh.visual import TextureVisuals

    vertices = split_vertices(mesh, faces, normals)
    has_uv = bool(mesh.has_uv[faces[0]])
    return {
        "vertices": vertices.positions,
        "faces": vertices.faces,
        "vertex_normals": vertices.normals,
        "visual": TextureVisuals(uv=vertices.uvs if has_uv else None, material=material),
        # trimesh would merge vertices, and shuffle the others.
        "process": False,
    }


def _pbr(material: Material, images: list[PIL.Image.Image], has_uv: bool) -> PBRMaterial:
    """trimesh's material, which has glTF's names; without UV it has factors alone."""
    from trimesh.visual.material import PBRMaterial

    used = material.maps.items() if has_uv else ()
    maps = {BY_NAME[slot].gltf_key: images[each.texture] for slot, each in used}
    return PBRMaterial(
        name=material.name,
        baseColorFactor=np.asarray(material.base_color),
        metallicFactor=material.metallic,
        roughnessFactor=material.roughness,
        emissiveFactor=material.emissive,
        alphaMode=material.alpha_mode.upper(),
        alphaCutoff=material.alpha_cutoff if material.alpha_mode == "mask" else None,
        doubleSided=material.double_sided,
        **maps,
    )


def _image(pixels: Uint8Array) -> PIL.Image.Image:
    import PIL.Image

    opaque = bool((pixels[..., 3] == 255).all())
    return PIL.Image.fromarray(pixels[..., :3] if opaque else pixels)
