"""How far the directions differ that normal maps give to paired points."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.core.asset import TextureMap
from nispcodec.core.texture import decode_image, sample_texture
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.surface import Surface, SurfacePoints
from nispcodec.metrics.uv import uv_at


def normal_angles(original: Surface, decoded: Surface, matches: Matches) -> Float64Array:
    """(k,): angles in degrees between mapped normals, of the pairs that both have a normal map.

    Both maps are read as glTF does, around the same normal, that of the original's face: what the
    surfaces themselves are apart by is no part of it. Where u grows is each surface's own, so that
    layouts may differ. Raises MeshError for a texture that does not decode.
    """
    axes = original.normals[matches.original.faces]
    first, mapped = _normals(original, matches.original, axes)
    second, also = _normals(decoded, matches.decoded, axes)
    both = mapped & also
    cosines = np.clip((first[both] * second[both]).sum(axis=1), -1.0, 1.0)
    # Near 0 an arc cosine is too rough.
    sines = np.linalg.norm(np.cross(first[both], second[both]), axis=1)
    return np.degrees(np.arctan2(sines, cosines))


def angle_summary(angles: Float64Array) -> dict[str, float]:
    """Mean, 99th percentile and maximum of (k,) angles."""
    return {
        "mean": float(angles.mean()),
        "p99": float(np.percentile(angles, 99)),
        "max": float(angles.max()),
    }


def _normals(
    surface: Surface, points: SurfacePoints, axes: Float64Array
) -> tuple[Float64Array, BoolArray]:
    """Unit normals (n, 3) by the maps at points, around `axes` (n, 3), and who has any."""
    mesh = surface.mesh
    texels = np.zeros((len(points), 3))
    mapped = np.zeros(len(points), np.bool_)
    uvs, owners = uv_at(surface, points), mesh.face_materials[points.faces]
    for number, material in enumerate(mesh.materials):
        used = material.maps.get("normal")
        chosen = (owners == number) & mesh.has_uv[points.faces]
        if used is not None and chosen.any():
            image = decode_image(mesh.textures[used.texture])[..., :3]
            read = sample_texture(image, uvs[chosen], used.wrap, used.filter)
            texels[chosen] = _directions(read.astype(np.float64), used)
            mapped |= chosen
    tangents, bitangents, usable = _frames(surface, points, axes)
    world = texels[:, :1] * tangents + texels[:, 1:2] * bitangents + texels[:, 2:] * axes
    return world, mapped & usable


def _directions(texels: Float64Array, used: TextureMap) -> Float64Array:
    """Unit vectors (n, 3) of texels (n, 3) in [0, 1]; glTF 2.0, 3.9.3."""
    vectors = (texels * 2 - 1) * (used.strength, used.strength, 1.0)
    return _unit(vectors)


def _frames(
    surface: Surface, points: SurfacePoints, axes: Float64Array
) -> tuple[Float64Array, Float64Array, BoolArray]:
    """Unit directions (n, 3), square to `axes`, in which u and v grow, and where they do."""
    a, b, c = surface.corners_of(points.faces).transpose(1, 0, 2)
    p, q, r = surface.mesh.corner_uvs[points.faces].transpose(1, 0, 2)
    first, second = q - p, r - p
    turn = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    along = (b - a) * second[:, 1:] - (c - a) * first[:, 1:]
    along *= np.sign(turn)[:, None]
    flat = along - (along * axes).sum(axis=1, keepdims=True) * axes
    tangents = _unit(flat)
    usable = (turn != 0) & (np.linalg.norm(flat, axis=1) > 0)
    return tangents, np.cross(axes, tangents) * np.sign(turn)[:, None], usable


def _unit(vectors: Float64Array) -> Float64Array:
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    units: Float64Array = vectors / np.maximum(lengths, np.finfo(np.float64).tiny)
    return units
