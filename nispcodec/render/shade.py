"""The one shader: the light that a point of a surface sends to the eye, however it was found.

Lambert and normalized Blinn-Phong under one lamp, and an even environment; metallic-roughness
materials as in glTF 2.0; all in linear light.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array
from nispcodec.core.asset import Material
from nispcodec.render.fragments import Fragments
from nispcodec.render.maps import Maps
from nispcodec.render.tangents import tangent_frames

ENVIRONMENT, LAMP = 0.25, 0.75
# Reflectance head-on of what is not metal (glTF 2.0, appendix B).
DIELECTRIC = 0.04
# A lamp without size would make a mirror black.
SMOOTHEST = 0.1


@dataclass(frozen=True)
class Look:
    """The material at n points, float32, in linear light.

    base, emissive                          (n, 3)
    normals                                 (n, 3) unit, towards the viewer, normal map applied
    alpha, metallic, roughness, occlusion   (n,)
    """

    base: Float32Array
    alpha: Float32Array
    metallic: Float32Array
    roughness: Float32Array
    occlusion: Float32Array
    emissive: Float32Array
    normals: Float32Array


def looks(
    points: Fragments,
    materials: tuple[Material, ...],
    maps: Maps,
    footprints: Float32Array,
    normal_map: bool = True,
) -> Iterator[tuple[BoolArray, Look]]:
    """The looks of n points, material by material: which points (n,) bool, and their look.

    `footprints` (n,): see `Maps.look_up`. Without `normal_map` normal maps are not applied. Raises
    MeshError for a texture that does not decode.
    """
    keys = 2 * points.materials + points.textured
    for key in np.unique(keys).tolist():
        chosen = keys == key
        material = materials[key // 2]
        dropped = set() if normal_map else {"normal"}
        used = {k: v for k, v in material.maps.items() if key % 2 and k not in dropped}
        yield chosen, _look(points[chosen], replace(material, maps=used), maps, footprints[chosen])


def shaded(look: Look, towards: Float32Array, lamp: Float32Array) -> Float32Array:
    """(n, 3) float32: linear light of points seen along unit directions `towards` (n, 3).

    `lamp` (3,) is the unit direction to the lamp.
    """
    incident = np.clip(look.normals @ lamp, 0, 1)[:, None]
    middle = lamp - towards
    middle /= np.maximum(np.linalg.norm(middle, axis=1, keepdims=True), 1e-6)
    aligned = np.clip((look.normals * middle).sum(axis=1), 0, 1)[:, None]
    exponent = 2 / np.maximum(look.roughness, SMOOTHEST)[:, None] ** 4 - 2
    gloss = (exponent + 2) / 8 * aligned**exponent
    metallic, occlusion = look.metallic[:, None], look.occlusion[:, None]
    reflectance = DIELECTRIC + (look.base - DIELECTRIC) * metallic
    diffuse = look.base * (1 - metallic)
    lit = LAMP * incident * (diffuse + reflectance * gloss)
    light: Float32Array = lit + ENVIRONMENT * occlusion * (diffuse + reflectance) + look.emissive
    return light.astype(np.float32)


def _look(points: Fragments, material: Material, maps: Maps, footprints: Float32Array) -> Look:
    def texels(slot: str) -> Float32Array:
        found = maps.look_up(material, slot, points, footprints)
        return np.ones((len(points), 4), np.float32) if found is None else found

    base = texels("base_color") * np.array(material.base_color, np.float32)
    rough = texels("metallic_roughness")
    strength = material.maps["occlusion"].strength if "occlusion" in material.maps else 1.0
    return Look(
        base=base[:, :3],
        alpha=_alpha(base[:, 3], material),
        metallic=rough[:, 2] * np.float32(material.metallic),
        roughness=rough[:, 1] * np.float32(material.roughness),
        occlusion=1 + np.float32(strength) * (texels("occlusion")[:, 0] - 1),
        emissive=texels("emissive")[:, :3] * np.array(material.emissive, np.float32),
        normals=_normals(points, material, maps, footprints),
    )


def _alpha(alpha: Float32Array, material: Material) -> Float32Array:
    if material.alpha_mode == "opaque":
        return np.ones_like(alpha)
    if material.alpha_mode == "mask":
        return (alpha >= material.alpha_cutoff).astype(np.float32)
    return alpha


def _normals(
    points: Fragments, material: Material, maps: Maps, footprints: Float32Array
) -> Float32Array:
    """Unit normals towards the viewer, turned by the normal map; it looks alike from both sides."""
    normals = np.where(points.facing[:, None], points.normals, -points.normals)
    texels = maps.look_up(material, "normal", points, footprints)
    if texels is None:
        return normals
    tangents, bitangents = tangent_frames(normals, points.jacobians)
    x, y, z = (2 * texels[:, :3] - 1).T[..., None]
    strength = np.float32(material.maps["normal"].strength)
    turned = strength * (x * tangents + y * bitangents) + z * normals
    return turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-6)
