"""Baking the model's colors into a new atlas."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.bake.rebake import baked_names, rebaked
from nispcodec.bake.tangents import frames_at
from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError
from nispcodec.core.texture import base_color, decode_image
from nispcodec.model import NispModel
from tests import tiny


@pytest.fixture(scope="module")
def model() -> NispModel:
    return NispModel(tiny.document())


@pytest.fixture(scope="module")
def plate(model: NispModel) -> TexturedMesh:
    """A square across the seam between the two charts, with an atlas that leaves a margin."""
    corners = np.array([[-0.3, -0.3, 0], [0.3, -0.3, 0], [0.3, 0.3, 0], [-0.3, 0.3, 0]])
    return TexturedMesh(
        positions=model.document.frame.to_world(corners),
        faces=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        uvs=np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]]),
        uv_faces=np.array([[0, 1, 2], [0, 2, 3]], np.int32),
        face_materials=np.zeros(2, np.int32),
    )


def test_texels_hold_the_models_colors(model: NispModel, plate: TexturedMesh) -> None:
    baked = rebaked(model, plate, 256)
    image = decode_image(baked.textures[0])
    assert image.shape == (256, 256, 4)
    rng = np.random.default_rng(0)
    shares = rng.dirichlet([1, 1, 1], 500)
    faces = rng.integers(0, 2, 500)
    points = np.einsum("nc,ncd->nd", shares, baked.corners[faces])
    uvs = np.einsum("nc,ncd->nd", shares, baked.corner_uvs[faces])
    away = np.abs(points[:, 0] - model.document.frame.center[0]) > 0.05
    found = base_color(baked.materials[0], image, uvs)
    np.testing.assert_allclose(found[away], model.color(points)[away], atol=0.03)


def test_margin_repeats_the_nearest_texel(model: NispModel, plate: TexturedMesh) -> None:
    image = decode_image(rebaked(model, plate, 64).textures[0])
    np.testing.assert_array_equal(image[32, 0], image[32, 7])
    assert image[0, 0, :3].sum() > 0


def test_the_names_are_known_before_the_textures(shaded: NispModel, plate: TexturedMesh) -> None:
    names = baked_names(shaded)
    mesh = rebaked(shaded, plate, 16)
    assert [texture.name for texture in mesh.textures] == list(names.values())
    assert list(mesh.materials[0].maps) == list(names)
    assert len(names) > 1


def test_one_material_and_one_texture_remain(model: NispModel) -> None:
    mesh = model.to_mesh(24)
    atlas = replace(mesh, uvs=(mesh.uvs - mesh.uvs.min()) / np.ptp(mesh.uvs))
    baked = rebaked(model, atlas, 32)
    assert len(baked.materials) == len(baked.textures) == 1
    assert not baked.face_materials.any()
    assert np.array_equal(baked.faces, mesh.faces)


def test_refusals(model: NispModel, plate: TexturedMesh) -> None:
    with pytest.raises(MeshError, match="16 to 8192"):
        rebaked(model, plate, 9000)
    with pytest.raises(MeshError, match="found 2 without"):
        rebaked(model, replace(plate, uv_faces=plate.uv_faces * 0 - 1), 64)


ATLASES = {
    "same": [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]],
    "turned": [[0.9, 0.1], [0.9, 0.9], [0.1, 0.9], [0.1, 0.1]],
    "mirrored": [[0.9, 0.1], [0.1, 0.1], [0.1, 0.9], [0.9, 0.9]],
}


@pytest.fixture(scope="module")
def shaded() -> NispModel:
    """All maps on all charts; normals lean by (0.6, 0, 0.8) towards growing u, which is y."""
    plain = tiny.document()
    leaning = np.array([[[round(255 * 0.8), 128, round(255 * 0.9)]]], np.uint8)
    rough = np.array([[[0, 128, 255]]], np.uint8)
    maps = {
        "normal": TextureMap(0),
        "metallic_roughness": TextureMap(1),
        "occlusion": TextureMap(1, strength=0.5),
        "emissive": TextureMap(1),
    }
    material = Material("all", metallic=0.5, roughness=0.5, emissive=(0, 0, 1.0), maps=maps)
    textures = (tiny.png(leaning, "normal.png"), tiny.png(rough, "rough.png"))
    return NispModel(replace(plain, materials=(material, material), textures=textures))


def wall(model: NispModel, uvs: list[list[float]]) -> TexturedMesh:
    """A square that faces x, corners in the order of growing y, then z."""
    corners = np.array([[0.3, -0.2, -0.2], [0.3, 0.2, -0.2], [0.3, 0.2, 0.2], [0.3, -0.2, 0.2]])
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    positions = model.document.frame.to_world(corners)
    return TexturedMesh(positions, faces, np.array(uvs), faces, np.zeros(2, np.int32))


@pytest.mark.parametrize("atlas", ATLASES)
def test_normals_keep_their_direction_in_space(shaded: NispModel, atlas: str) -> None:
    mesh = wall(shaded, ATLASES[atlas])
    baked = rebaked(shaded, mesh, 32)
    used = baked.materials[0].maps["normal"]
    x, y, z = (2 * decode_image(baked.textures[used.texture])[16, 16, :3] - 1).tolist()
    frames = frames_at(mesh, np.zeros(1, np.int32), np.full((1, 3), 1 / 3))
    seen = x * frames.tangents[0] + y * frames.bitangents[0] + z * np.array([1.0, 0, 0])
    np.testing.assert_allclose(seen, [0.8, 0.6, 0], atol=0.02)


def test_factors_and_strengths_go_into_the_texels(shaded: NispModel) -> None:
    baked = rebaked(shaded, wall(shaded, ATLASES["same"]), 16)
    material = baked.materials[0]
    assert (material.metallic, material.roughness, material.emissive) == (1, 1, (1, 1, 1))
    expected = {
        "metallic_roughness": (0, 0.25, 0.5),
        "occlusion": (0.5, 0.75, 1),
        "emissive": (0, 0, 1),
    }
    for slot, values in expected.items():
        image = decode_image(baked.textures[material.maps[slot].texture])
        np.testing.assert_allclose(image[8, 8, :3], values, atol=0.01)
