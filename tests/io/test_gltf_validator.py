"""glTF output under the Khronos validator, where node and its package are present."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.measuring.gltf_validator import issues, lacking
from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.io.save import write_mesh
from nispcodec.io.write.gltf_compression import COMPRESSIONS
from nispcodec.model import NispModel
from tests import tiny


@pytest.fixture(scope="module", autouse=True)
def validator() -> None:
    if why := lacking():
        pytest.skip(why)


def issues_of(
    mesh: TexturedMesh,
    folder: Path,
    colors: np.ndarray | None = None,
    compress: str | None = None,
    name: str = "out.glb",
) -> dict[str, Any]:
    """The validator's issues with the mesh written as glTF."""
    return issues(write_mesh(mesh, folder / name, colors, compress)[-1])


def every_map(document_textures: int) -> Material:
    slots = ("base_color", "normal", "metallic_roughness", "occlusion", "emissive")
    used = {slot: TextureMap(i % document_textures) for i, slot in enumerate(slots)}
    return Material("all maps", maps=used, alpha_mode="mask", emissive=(1.0, 0.5, 0.0))


@pytest.mark.parametrize("compress", [None, *COMPRESSIONS])
def test_decoded_meshes_are_valid(tmp_path: Path, compress: str | None) -> None:
    plain = tiny.document()
    every = replace(plain, materials=(every_map(1), plain.materials[1]))
    for document in (plain, every):
        report = issues_of(NispModel(document).to_mesh(32), tmp_path, None, compress)
        assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


@pytest.mark.parametrize("compress", [None, *COMPRESSIONS])
def test_files_beside_a_gltf_are_valid(tmp_path: Path, compress: str | None) -> None:
    mesh = NispModel(tiny.document()).to_mesh(32)
    report = issues_of(mesh, tmp_path, None, compress, "a: 100 % #1 ?.gltf")
    assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


def test_mesh_without_uv_is_valid(tmp_path: Path) -> None:
    mesh = NispModel(tiny.document()).to_mesh(24)
    bare = replace(mesh, uv_faces=mesh.uv_faces * 0 - 1, materials=(every_map(1),) * 2)
    report = issues_of(bare, tmp_path)
    assert report["numErrors"] == 0, report["messages"]


def test_vertex_colors_are_valid(tmp_path: Path) -> None:
    model = NispModel(tiny.document())
    mesh = model.to_mesh(24)
    report = issues_of(mesh, tmp_path, model.color(mesh.positions))
    assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


def test_the_validator_would_notice(tmp_path: Path) -> None:
    mesh = NispModel(tiny.document()).to_mesh(24)
    broken = replace(mesh, materials=(Material(roughness=7.0),) * 2)
    assert issues_of(broken, tmp_path)["numErrors"] > 0
