"""Texels of a material's other maps at points of the model, factors and strengths multiplied in.

So points of several materials can share one texture, as a new atlas wants it.
"""

from __future__ import annotations

import numpy as np

from nispcodec.bake.tangents import TangentFrames
from nispcodec.core.arrays import Float32Array, Float64Array, Int32Array
from nispcodec.core.asset import Material
from nispcodec.core.slots import BY_NAME, SLOTS
from nispcodec.core.texture import decode_image, linear_to_srgb, sample_texture, srgb_to_linear
from nispcodec.model import NispModel

# How far to go, in radii, to see which way a UV grows.
STEP = 2e-3


def further_slots(model: NispModel) -> tuple[str, ...]:
    """The slots besides the base color for which a material has a map."""
    materials = model.document.materials
    return tuple(slot for slot in SLOTS[1:] if any(slot in each.maps for each in materials))


def baked_maps(
    model: NispModel, points: Float64Array, frames: TangentFrames
) -> dict[str, Float32Array]:
    """Texels (n, 3) in [0, 1], as stored in images, of every further slot at world points (n, 3).

    Normals are turned from the directions of the old UVs into those of `frames`. Raises MeshError
    for a texture that does not decode.
    """
    charts = model.charts(points)
    uvs = model.uv(points, charts=charts)
    baked = {slot: _texels(model, slot, charts, uvs) for slot in further_slots(model)}
    if "normal" in baked:
        normals = _turned(model, baked["normal"], points, charts, frames)
        baked["normal"] = (normals + np.float32(1)) * np.float32(0.5)
    return baked


def _texels(model: NispModel, slot: str, charts: Int32Array, uvs: Float32Array) -> Float32Array:
    document = model.document
    has_uv, owners = document.chart_has_uv[charts], document.chart_materials[charts]
    texels = np.empty((len(charts), 3), np.float32)
    texels[:] = BY_NAME[slot].blank[:3]
    for number in np.unique(owners).tolist():
        material = document.materials[number]
        used = material.maps.get(slot)
        seen = (owners == number) & has_uv
        if used is not None and seen.any():
            image = decode_image(document.textures[used.texture])[..., :3]
            texels[seen] = sample_texture(image, uvs[seen], used.wrap, used.filter)
        texels[owners == number] = _finished(slot, material, texels[owners == number])
    return texels


def _finished(slot: str, material: Material, texels: Float32Array) -> Float32Array:
    """Texels with the material's factors and strength; for normals vectors of any length."""
    strength = material.maps[slot].strength if slot in material.maps else 1.0
    if slot == "metallic_roughness":
        return texels * np.array([1, material.roughness, material.metallic], np.float32)
    if slot == "occlusion":
        return 1 + np.float32(strength) * (texels - 1)
    if slot == "emissive":
        glow = np.array(material.emissive, np.float32)
        return linear_to_srgb(np.clip(srgb_to_linear(texels) * glow, 0, 1))
    return (2 * texels - 1) * np.array([strength, strength, 1], np.float32)


def _turned(
    model: NispModel,
    normals: Float32Array,
    points: Float64Array,
    charts: Int32Array,
    frames: TangentFrames,
) -> Float32Array:
    """Normals (n, 3) of the old tangent space in the new one: both lie in the same plane.

    So x and y are turned, and mirrored where the old UVs are, by how the old u and v grow along the
    new directions.
    """
    step = STEP * model.document.frame.radius
    start = model.uv(points, charts=charts)
    along = model.uv(points + step * frames.tangents, charts=charts) - start
    across = model.uv(points + step * frames.bitangents, charts=charts) - start
    determinant = along[:, 0] * across[:, 1] - across[:, 0] * along[:, 1]
    mirrored = np.where(determinant < 0, np.float32(-1), np.float32(1))
    # The direction in which the old u grows while the old v stays: a column of the inverse.
    right = np.stack([across[:, 1], -along[:, 1]], axis=1) * mirrored[:, None]
    right[determinant == 0] = (1, 0)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.stack([-right[:, 1], right[:, 0]], axis=1) * mirrored[:, None]
    turned = np.column_stack([normals[:, :1] * right + normals[:, 1:2] * up, normals[:, 2]])
    units: Float32Array = turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-6)
    return units.astype(np.float32)
