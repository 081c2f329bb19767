"""In Blender itself: the extension is installed, imports, exports, and says what is wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nispcodec
from nispcodec.core.asset import Material, TextureMap
from nispcodec.core.document import Document
from nispcodec.core.texture import image_bytes
from nispcodec.format import pack
from tests import tiny

ROOT = Path(__file__).parents[2]
BPY = Path(os.environ.get("NISPCODEC_BPY_PYTHON", ROOT / "build" / "blender" / "bin" / "python"))
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not BPY.exists(), reason="Blender's package bpy is missing: make blender"),
]
SLOTS = ("base_color", "normal", "metallic_roughness", "occlusion", "emissive")


def document() -> Document:
    """An octahedron of two materials, one of which has everything."""
    random = np.random.default_rng(0)
    images = tuple(
        tiny.png(random.integers(0, 255, (4, 4, 3), dtype=np.uint8), f"{slot}.png")
        for slot in SLOTS
    )
    maps = {slot: TextureMap(number) for number, slot in enumerate(SLOTS)}
    maps["base_color"] = TextureMap(0, ("clamp", "clamp"), "nearest")
    factors = ((1.0, 1.0, 1.0, 0.5), 0.25, 0.75, (0.5, 0.25, 1.0))
    materials = (
        Material("wood", *factors, "blend", 0.5, True, maps),
        Material("plain", (0.2, 0.4, 0.6, 1.0), 0.1, 0.9),
    )
    return replace(tiny.document(), materials=materials, textures=images)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `in_blender.py` was given, and what it left."""
    folder = tmp_path_factory.mktemp("blender")
    (folder / "model.nisp").write_bytes(pack(document()))
    source, archive = ROOT / "addons" / "blender", folder / "extension.zip"
    build = ("build", "--source-dir", source, "--output-filepath", archive)
    in_blender(folder, extension_tool(), *build)
    in_blender(folder, Path(__file__).with_name("in_blender.py"), folder, sys.prefix)
    return folder


def in_blender(folder: Path, *arguments: str | Path) -> str:
    """Run Blender's Python with a user's folder of its own."""
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(folder / "user")}
    command = [str(BPY), *map(str, arguments)]
    run = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=600)
    assert run.returncode == 0, run.stdout + run.stderr
    return run.stdout


def extension_tool() -> Path:
    """Blender's own command that checks and packs extensions."""
    return next(BPY.parents[1].rglob("bl_pkg/cli/blender_ext.py"))


@pytest.fixture(scope="module")
def seen(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "seen.json").read_text())
    return found


def test_blender_calls_the_extension_valid(folder: Path) -> None:
    for what in (ROOT / "addons" / "blender", folder / "extension.zip"):
        assert "Success" in in_blender(folder, extension_tool(), "validate", what)


def test_the_mesh_is_closed_and_where_it_should_be(seen: dict[str, Any]) -> None:
    (made,) = seen["objects"]
    assert made["name"] == made["mesh"] == "model"
    # Seams are in the UVs alone: Euler's formula of a closed surface.
    assert made["vertices"] == made["faces"] // 2 + 2
    assert made["materials"] == ["wood", "plain"]
    assert made["uv_layers"] == 1
    # glTF's y is up, in Blender z is.
    assert made["place"] == pytest.approx([1, -3, 2], abs=0.01)
    assert made["size"] == pytest.approx([3.2] * 3, abs=0.01)


def test_maps_are_colors_where_they_are_and_data_elsewhere(seen: dict[str, Any]) -> None:
    images = seen["materials"]["wood"]["images"]
    color = ["base_color.png", "sRGB", "EXTEND", "Closest"]
    data = ["metallic_roughness.png", "Non-Color", "REPEAT", "Linear"]
    assert images == {
        "Base Color": [color],
        "Alpha": [color],
        "Metallic": [data],
        "Roughness": [data],
        "Normal": [["normal.png", "Non-Color", "REPEAT", "Linear"]],
        "Emission Color": [["emissive.png", "sRGB", "REPEAT", "Linear"]],
    }
    assert "NORMAL_MAP" in seen["materials"]["wood"]["nodes"]


def test_factors_alpha_and_sides_are_those_of_the_file(seen: dict[str, Any]) -> None:
    wood, plain = seen["materials"]["wood"], seen["materials"]["plain"]
    assert (wood["surface"], wood["culled"]) == ("BLENDED", False)
    assert (plain["surface"], plain["culled"]) == ("DITHERED", True)
    assert plain["images"] == {}
    assert plain["values"]["Base Color"] == [0.2, 0.4, 0.6, 1.0]
    assert (plain["values"]["Metallic"], plain["values"]["Roughness"]) == (0.1, 0.9)
    assert plain["values"]["Emission Strength"] == 0


def test_what_is_exported_is_the_same_asset(seen: dict[str, Any], folder: Path) -> None:
    assert (seen["imported"], seen["exported"]) == (["FINISHED"], ["FINISHED"])
    first, again = document(), nispcodec.load(folder / "again.nisp")
    points = np.random.default_rng(0).uniform(-1, 1, (300, 3)) + first.frame.center
    expected = nispcodec.NispModel(first).sdf(points)
    inside = expected < 0
    assert 50 < inside.sum() < 250
    assert np.abs(again.sdf(points[inside]) - expected[inside]).max() < 0.06
    found = {each.name: each for each in again.document.materials}
    for each in first.materials:
        same = found[each.name]
        assert np.allclose(same.base_color, each.base_color, atol=1e-3)
        assert np.allclose(
            [same.metallic, same.roughness, *same.emissive],
            [each.metallic, each.roughness, *each.emissive],
            atol=1e-3,
        )
        assert (same.alpha_mode, same.double_sided) == (each.alpha_mode, each.double_sided)
        assert set(same.maps) == set(each.maps)
    used = found["wood"].maps["normal"].texture
    assert np.array_equal(
        image_bytes(again.document.textures[used]), image_bytes(first.textures[1])
    )


def test_mistakes_are_said_in_a_sentence(seen: dict[str, Any]) -> None:
    no_file, faces, environment, nothing = seen["errors"]
    assert "seen.json: expected" in no_file
    assert "4 faces or more" in faces
    assert "expected the command nisp or its environment" in environment
    assert "Select a mesh object" in nothing


def test_nothing_is_left_when_it_is_switched_off(seen: dict[str, Any]) -> None:
    assert not seen["left"]
