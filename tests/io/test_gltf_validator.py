"""GLB output under the Khronos validator, where node and the package gltf-validator are present."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.io.save import write_mesh
from nispcodec.io.write.gltf_compression import COMPRESSIONS
from nispcodec.model import NispModel
from tests import tiny

HERE = Path(__file__).parent
PACKAGES = HERE.parents[1] / "build" / "node" / "node_modules"
INSTALL = "npm install --prefix build/node gltf-validator"


@pytest.fixture(scope="module")
def node() -> list[str]:
    """The command that validates a GLB."""
    found = shutil.which("node")
    if found is None:
        pytest.skip("node is not installed")
    if not (PACKAGES / "gltf-validator").is_dir():
        pytest.skip(f"gltf-validator is not installed: {INSTALL}")
    return [found, str(HERE / "validate_gltf.cjs")]


def issues(
    node: list[str],
    mesh: TexturedMesh,
    folder: Path,
    colors: np.ndarray | None = None,
    compress: str | None = None,
    name: str = "out.glb",
) -> dict[str, Any]:
    """The validator's issues with the mesh written as glTF."""
    path = write_mesh(mesh, folder / name, colors, compress)[-1]
    environment = os.environ | {"NODE_PATH": str(PACKAGES)}
    run = subprocess.run(
        [*node, str(path)], capture_output=True, text=True, check=True, env=environment, timeout=60
    )
    return json.loads(run.stdout)


def every_map(document_textures: int) -> Material:
    slots = ("base_color", "normal", "metallic_roughness", "occlusion", "emissive")
    used = {slot: TextureMap(i % document_textures) for i, slot in enumerate(slots)}
    return Material("all maps", maps=used, alpha_mode="mask", emissive=(1.0, 0.5, 0.0))


def test_decoded_mesh_is_valid(node: list[str], tmp_path: Path) -> None:
    plain = tiny.document()
    model = NispModel(replace(plain, materials=(every_map(1), plain.materials[1])))
    report = issues(node, model.to_mesh(32), tmp_path)
    assert report["numErrors"] == 0, report["messages"]
    # Tangents are left to the viewer, as the specification allows; the validator mentions it.
    codes = {item["code"] for item in report["messages"] if item["severity"] < 2}
    assert codes <= {"MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"}


@pytest.mark.parametrize("compress", COMPRESSIONS)
def test_compressed_meshes_are_valid(node: list[str], tmp_path: Path, compress: str) -> None:
    report = issues(node, NispModel(tiny.document()).to_mesh(32), tmp_path, None, compress)
    assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


@pytest.mark.parametrize("compress", [None, *COMPRESSIONS])
def test_files_beside_a_gltf_are_valid(
    node: list[str], tmp_path: Path, compress: str | None
) -> None:
    mesh = NispModel(tiny.document()).to_mesh(32)
    report = issues(node, mesh, tmp_path, None, compress, "a: 100 % #1 ?.gltf")
    assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


def test_mesh_without_uv_is_valid(node: list[str], tmp_path: Path) -> None:
    mesh = NispModel(tiny.document()).to_mesh(24)
    bare = replace(mesh, uv_faces=mesh.uv_faces * 0 - 1, materials=(every_map(1),) * 2)
    report = issues(node, bare, tmp_path)
    assert report["numErrors"] == 0, report["messages"]


def test_vertex_colors_are_valid(node: list[str], tmp_path: Path) -> None:
    model = NispModel(tiny.document())
    mesh = model.to_mesh(24)
    report = issues(node, mesh, tmp_path, model.color(mesh.positions))
    assert report["numErrors"] == report["numWarnings"] == 0, report["messages"]


def test_the_validator_would_notice(node: list[str], tmp_path: Path) -> None:
    mesh = NispModel(tiny.document()).to_mesh(24)
    broken = replace(mesh, materials=(Material(roughness=7.0),) * 2)
    assert issues(node, broken, tmp_path)["numErrors"] > 0
