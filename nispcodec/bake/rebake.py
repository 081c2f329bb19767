"""New textures for a mesh with a new atlas, painted by asking the model at every texel."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO

import numpy as np

from nispcodec.bake.maps import baked_maps, further_slots
from nispcodec.bake.tangents import frames_at
from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.extras import require
from nispcodec.core.raster import Texels, padded, texels
from nispcodec.model import NispModel

SIZES = (16, 8192)


def baked_names(model: NispModel) -> dict[str, str]:
    """The file name of each texture that `rebaked` makes, by its slot."""
    return {slot: f"baked_{slot}.png" for slot in ("base_color", *further_slots(model))}


def rebaked(model: NispModel, mesh: TexturedMesh, size: int = 1024) -> TexturedMesh:
    """The mesh with one material: textures of `size` x `size` texels for the model's maps.

    `mesh`, in the world frame, has an atlas of its own: every face with UVs in [0, 1], none over
    another. Texels outside the atlas take the color of the nearest texel inside, so that no
    filter and no mip level bleeds. Raises MeshError when faces have no UVs, the size is not 16 to
    8192, or a texture does not decode, NispError without the extra `unwrap`.
    """
    require("scipy", extra="unwrap", what_for="rebaking")
    if not SIZES[0] <= size <= SIZES[1]:
        raise MeshError(f"size: expected {SIZES[0]} to {SIZES[1]} texels, found {size}")
    if not mesh.has_uv.all():
        raise MeshError(f"rebake: expected UVs on all faces, found {(~mesh.has_uv).sum()} without")
    found = texels(mesh.corner_uvs, size, size)
    points = np.einsum("nc,ncd->nd", found.weights, mesh.corners[found.faces])
    colors = model.color(points)
    translucent = bool((colors[:, 3] < 1).any())
    pictures = {"base_color": colors if translucent else colors[:, :3]}
    if further_slots(model):
        frames = frames_at(mesh, found.faces, found.weights)
        pictures |= baked_maps(model, points, frames)
    names = baked_names(model)
    return replace(
        mesh,
        face_materials=np.zeros_like(mesh.face_materials),
        materials=(_material(mesh, list(pictures), translucent),),
        textures=tuple(
            Texture(names[slot], _png(values, found, size), "image/png")
            for slot, values in pictures.items()
        ),
    )


def _png(values: Float32Array, found: Texels, size: int) -> bytes:
    """An image of the texels' values (n, c), which lie in [0, 1]."""
    from PIL import Image

    image = np.zeros((size, size, values.shape[1]), np.uint8)
    image[found.rows, found.columns] = np.rint(np.clip(values, 0, 1) * 255)
    covered = np.zeros((size, size), np.bool_)
    covered[found.rows, found.columns] = True
    data = BytesIO()
    Image.fromarray(padded(image, covered)).save(data, "PNG")
    return data.getvalue()


def _material(mesh: TexturedMesh, slots: list[str], translucent: bool) -> Material:
    """What is not in textures now is that of the material of most faces."""
    most = mesh.materials[int(np.bincount(mesh.face_materials).argmax())]
    through = "mask" if most.alpha_mode == "mask" else "blend"
    rough, glowing = "metallic_roughness" in slots, "emissive" in slots
    clamped = ("clamp", "clamp")
    return replace(
        most,
        name="baked",
        base_color=(1.0, 1.0, 1.0, 1.0),
        metallic=1.0 if rough else most.metallic,
        roughness=1.0 if rough else most.roughness,
        emissive=(1.0, 1.0, 1.0) if glowing else most.emissive,
        alpha_mode=through if translucent else "opaque",
        maps={slot: TextureMap(number, wrap=clamped) for number, slot in enumerate(slots)},
    )
