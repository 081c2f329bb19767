"""New textures for a mesh with a new atlas, painted by asking the model at every texel."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from nispcodec.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.decode.maps import baked_maps, further_slots
from nispcodec.decode.model import NispModel
from nispcodec.decode.tangents import frames_at
from nispcodec.errors import MeshError

SIZES = (16, 8192)
CANDIDATES = 1 << 21

Floats = NDArray[np.float64]
Integers = NDArray[np.int32]


@dataclass(frozen=True)
class Texels:
    """Texels that a face covers: row, column and face (n,), barycentric weights (n, 3)."""

    rows: Integers
    columns: Integers
    faces: Integers
    weights: Floats


def rebaked(model: NispModel, mesh: TexturedMesh, size: int = 1024) -> TexturedMesh:
    """The mesh with one material: textures of `size` x `size` texels for the model's maps.

    `mesh`, in the world frame, has an atlas of its own: every face with UVs in [0, 1], none over
    another. Texels outside the atlas take the colour of the nearest texel inside, so that no
    filter and no mip level bleeds. Raises MeshError when faces have no UVs or the size is not
    16 to 8192.
    """
    if not SIZES[0] <= size <= SIZES[1]:
        raise MeshError(f"size: expected {SIZES[0]} to {SIZES[1]} texels, found {size}")
    if not mesh.has_uv.all():
        raise MeshError(f"rebake: expected UVs on all faces, found {(~mesh.has_uv).sum()} without")
    texels = _texels(mesh, size)
    points = np.einsum("nc,ncd->nd", texels.weights, mesh.corners[texels.faces])
    colors = model.color(points)
    translucent = bool((colors[:, 3] < 1).any())
    pictures = {"base_color": colors if translucent else colors[:, :3]}
    if further_slots(model):
        frames = frames_at(mesh, texels.faces, texels.weights)
        pictures |= baked_maps(model, points, frames)
    return replace(
        mesh,
        face_materials=np.zeros_like(mesh.face_materials),
        materials=(_material(mesh, list(pictures), translucent),),
        textures=tuple(
            Texture(f"baked_{slot}.png", _png(values, texels, size), "image/png")
            for slot, values in pictures.items()
        ),
    )


def _texels(mesh: TexturedMesh, size: int) -> Texels:
    """Every texel whose centre a face covers."""
    owners = np.full((size, size), -1, np.int32)
    weights = np.zeros((size, size, 3))
    pixels: Floats = mesh.corner_uvs * [size, -size] + [0.0, size]
    for faces, x, y in _candidates(pixels, size):
        shares = _barycentric(pixels[faces], np.column_stack([x + 0.5, y + 0.5]))
        inside = (shares >= -1e-9).all(axis=1)
        owners[y[inside], x[inside]] = faces[inside]
        weights[y[inside], x[inside]] = shares[inside]
    rows, columns = (where.astype(np.int32) for where in np.nonzero(owners >= 0))
    return Texels(rows, columns, owners[rows, columns], weights[rows, columns])


def _candidates(pixels: Floats, size: int) -> Iterator[tuple[Integers, Integers, Integers]]:
    """Faces with the texels of their bounding boxes (face, x, y), some millions at a time."""
    low = np.clip(np.floor(pixels.min(axis=1)), 0, size - 1).astype(np.int32)
    high = np.clip(np.floor(pixels.max(axis=1)), 0, size - 1).astype(np.int32)
    spans = high - low + 1
    counts = spans.prod(axis=1, dtype=np.int64)
    bins = (np.cumsum(counts) - 1) // CANDIDATES
    for part in np.split(np.arange(len(counts)), np.flatnonzero(np.diff(bins)) + 1):
        faces = np.repeat(part, counts[part])
        within = np.arange(len(faces)) - np.repeat(
            np.cumsum(counts[part]) - counts[part], counts[part]
        )
        x, y = low[faces, 0] + within % spans[faces, 0], low[faces, 1] + within // spans[faces, 0]
        yield faces.astype(np.int32), x.astype(np.int32), y.astype(np.int32)


def _barycentric(triangles: Floats, points: Floats) -> Floats:
    """Weights (n, 3) of points (n, 2) in triangles (n, 3, 2); -1 in triangles without area."""
    a, b, c = triangles.transpose(1, 0, 2)
    u, v, w = b - a, c - a, points - a
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    second = np.full(len(points), -1.0)
    third = np.full(len(points), -1.0)
    np.divide(w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0], area, out=second, where=area != 0)
    np.divide(u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0], area, out=third, where=area != 0)
    return np.column_stack([1 - second - third, second, third])


def _png(values: NDArray[np.float32], texels: Texels, size: int) -> bytes:
    """An image of the texels' values (n, c), which lie in [0, 1]."""
    from PIL import Image

    image = np.zeros((size, size, values.shape[1]), np.uint8)
    image[texels.rows, texels.columns] = np.rint(np.clip(values, 0, 1) * 255)
    data = BytesIO()
    Image.fromarray(_padded(image, texels)).save(data, "PNG")
    return data.getvalue()


def _padded(image: NDArray[np.uint8], texels: Texels) -> NDArray[np.uint8]:
    from scipy.ndimage import distance_transform_edt

    empty = np.ones(image.shape[:2], np.bool_)
    empty[texels.rows, texels.columns] = False
    if empty.all():
        return image
    nearest = distance_transform_edt(empty, return_distances=False, return_indices=True)
    return np.ascontiguousarray(image[tuple(nearest)])


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
