"""Compressed GLB: what is read back is what was written, but for rounding."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError, NispError
from nispcodec.io.load import load_mesh
from nispcodec.io.save import write_mesh
from nispcodec.io.write.gltf_compression import COMPRESSIONS
from nispcodec.model import NispModel
from tests import tiny

ALL = pytest.mark.parametrize("how", COMPRESSIONS)

PACKAGES = {"draco": "DracoPy", "meshopt": "meshoptimizer"}


@pytest.fixture(scope="module")
def mesh() -> TexturedMesh:
    """Two materials, a seam, UVs within [0, 1] in one and beyond it in the other."""
    found = NispModel(tiny.document()).to_mesh(24)
    moved = np.unique(found.uv_faces[found.face_materials == 1])
    uvs = found.uvs.copy()
    uvs[moved] += 3
    return replace(found, uvs=uvs)


def json_of(path: Path) -> Any:
    data = path.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def back(mesh: TexturedMesh, folder: Path, how: str) -> TexturedMesh:
    if how in PACKAGES:
        pytest.importorskip(PACKAGES[how], reason="the extra `gltf` is not installed")
    found = load_mesh(write_mesh(mesh, folder / f"{how}.glb", compress=how)[-1])
    assert not found.warnings
    return found


@ALL
def test_faces_come_back(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    found = back(mesh, tmp_path, how)
    assert len(found.faces) == len(mesh.faces)
    size = np.ptp(mesh.positions, axis=0).max()
    middles = [np.sort(each.corners.mean(axis=1), axis=0) for each in (mesh, found)]
    np.testing.assert_allclose(middles[1], middles[0], atol=4e-5 * size)
    for material in (0, 1):
        uvs = [
            np.sort(each.corner_uvs[each.face_materials == material].mean(axis=1), axis=0)
            for each in (mesh, found)
        ]
        np.testing.assert_allclose(uvs[1], uvs[0], atol=2e-4)
    assert [each.data for each in found.textures] == [each.data for each in mesh.textures]


@ALL
def test_gltf_and_its_buffer_are_a_glb(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    inside = back(mesh, tmp_path, how)
    found = load_mesh(write_mesh(mesh, tmp_path / "out.gltf", compress=how)[-1])
    np.testing.assert_array_equal(found.corners, inside.corners)
    assert [each.data for each in found.textures] == [each.data for each in mesh.textures]


@ALL
def test_primitives_still_meet(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    found = back(mesh, tmp_path, how)
    left, right = (
        {tuple(row) for row in found.corners[found.face_materials == each].reshape(-1, 3).tolist()}
        for each in (0, 1)
    )
    sides = [np.unique(mesh.faces[mesh.face_materials == each]) for each in (0, 1)]
    shared = np.intersect1d(sides[0], sides[1])
    assert len(left & right) >= len(shared) > 0


@ALL
def test_tangents_are_of_eight_bits(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    bumpy = {"base_color": TextureMap(0), "normal": TextureMap(0)}
    made = replace(mesh, materials=tuple(replace(each, maps=bumpy) for each in mesh.materials))
    back(made, tmp_path, how)
    tree = json_of(tmp_path / f"{how}.glb")
    assert "KHR_mesh_quantization" in tree["extensionsRequired"]
    for primitive in tree["meshes"][0]["primitives"]:
        names = primitive["attributes"]
        stated, places = (tree["accessors"][names[name]] for name in ("TANGENT", "POSITION"))
        assert (stated["componentType"], stated["type"]) == (5120, "VEC4")
        assert stated["normalized"]
        assert stated["count"] == places["count"]


@ALL
def test_it_is_smaller_and_says_what_it_needs(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    back(mesh, tmp_path, how)
    plain = write_mesh(mesh, tmp_path / "plain.glb")[-1]
    path = tmp_path / f"{how}.glb"
    assert path.stat().st_size < 0.7 * plain.stat().st_size
    tree = json_of(path)
    assert tree["extensionsUsed"] == tree["extensionsRequired"] != []
    if how == "meshopt":
        assert tree["buffers"][1]["extensions"]["EXT_meshopt_compression"] == {"fallback": True}


@ALL
def test_a_mesh_far_away_stays_there(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    far = replace(mesh, positions=mesh.positions + np.array([1e6, 0, 0]))
    found = back(far, tmp_path, how)
    np.testing.assert_allclose(found.positions.mean(axis=0)[0], far.positions.mean(axis=0)[0], 1e-6)


@ALL
def test_colors_are_kept(mesh: TexturedMesh, tmp_path: Path, how: str) -> None:
    if how in PACKAGES:
        pytest.importorskip(PACKAGES[how], reason="the extra `gltf` is not installed")
    colors = np.random.default_rng(0).uniform(size=(len(mesh.positions), 4)).astype(np.float32)
    path = write_mesh(mesh, tmp_path / "out.glb", colors, how)[-1]
    (primitive,) = json_of(path)["meshes"][0]["primitives"]
    stated = json_of(path)["accessors"][primitive["attributes"]["COLOR_0"]]
    assert stated["normalized"]
    assert stated["type"] == "VEC4"


def test_what_cannot_be_is_refused(
    mesh: TexturedMesh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(MeshError, match=r"expected \.glb or \.gltf for the compression meshopt"):
        write_mesh(mesh, tmp_path / "out.obj", compress="meshopt")
    with pytest.raises(MeshError, match="expected one of draco, meshopt, quantize, found 'zip'"):
        write_mesh(mesh, tmp_path / "out.glb", compress="zip")
    monkeypatch.setattr("nispcodec.core.extras.find_spec", lambda name: None)
    with pytest.raises(NispError, match=r"nispcodec\[gltf\]"):
        write_mesh(mesh, tmp_path / "out.glb", compress="draco")
    assert not list(tmp_path.iterdir())
