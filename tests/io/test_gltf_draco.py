from __future__ import annotations

from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import DracoPy
import numpy as np
import pytest

from nispcodec.core import extras
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.io.folder import Folder
from nispcodec.io.read import gltf_draco
from nispcodec.io.read.gltf import read_gltf
from tests.io.files import Gltf, outcome

DRACO = "KHR_draco_mesh_compression"
POSITIONS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], np.float32)
FACES = np.array([(0, 1, 2), (2, 1, 3)], np.uint32)
NOWHERE = Folder(Path("/nonexistent"))
# DracoPy gives texture coordinates and positions the ids that follow those of other attributes.
IDS = {"TEXCOORD_0": 8, "POSITION": 9, "JOINTS_0": 5, "WEIGHTS_0": 7}


def stream(positions: AnyArray = POSITIONS, **more: Any) -> bytes:
    """A Draco stream whose texture coordinates are the first two coordinates."""
    weights = np.array([(1, 0, 0, 0)] * len(positions), np.float32)
    generic = {5: np.zeros((len(positions), 4), np.uint8), 7: weights}
    return DracoPy.encode(
        positions,
        FACES,
        tex_coord=positions[:, :2].astype(np.float64),
        generic_attributes=generic,
        quantization_bits=16,
        **more,
    )


def compressed(
    gltf: Gltf, data: bytes, names: tuple[str, ...] = ("POSITION", "TEXCOORD_0"), **more: Any
) -> dict[str, Any]:
    """A primitive of the stream, whose accessors have no bytes of their own."""
    kinds = {"POSITION": "VEC3", "TEXCOORD_0": "VEC2", "JOINTS_0": "VEC4", "WEIGHTS_0": "VEC4"}
    attributes = {}
    for name in names:
        component = 5121 if name == "JOINTS_0" else 5126
        gltf.json["accessors"].append({"componentType": component, "count": 4, "type": kinds[name]})
        attributes[name] = len(gltf.json["accessors"]) - 1
    gltf.json["accessors"].append({"componentType": 5123, "count": 6, "type": "SCALAR"})
    ids = {name: IDS[name] for name in names}
    return {
        "attributes": attributes,
        "indices": len(gltf.json["accessors"]) - 1,
        "extensions": {DRACO: {"bufferView": gltf.view(data), "attributes": ids}},
        **more,
    }


def square(data: bytes | None = None, **more: Any) -> Gltf:
    gltf = Gltf()
    gltf.json["extensionsRequired"] = [DRACO]
    return gltf.scene([compressed(gltf, data or stream(), **more)])


def expect_square(mesh: TexturedMesh, positions: AnyArray = POSITIONS) -> None:
    assert len(mesh.faces) == len(FACES)
    found, expected = (
        np.sort(each.mean(axis=1), axis=0) for each in (mesh.corners, positions[FACES])
    )
    np.testing.assert_allclose(found, expected, atol=1e-4)
    np.testing.assert_allclose(mesh.corner_uvs[..., 0], mesh.corners[..., 0], atol=1e-4)
    np.testing.assert_allclose(mesh.corner_uvs[..., 1], 1 - mesh.corners[..., 1], atol=1e-4)


def test_attributes_are_found_by_unique_id(tmp_path: Path) -> None:
    mesh = square().load(tmp_path)
    expect_square(mesh)
    assert mesh.warnings == ()


@pytest.mark.parametrize("order", [True, False])
def test_both_ways_of_encoding(tmp_path: Path, order: bool) -> None:
    expect_square(square(stream(preserve_order=order)).load(tmp_path))


def test_several_primitives_and_nodes(tmp_path: Path) -> None:
    gltf = Gltf()
    far = POSITIONS + np.float32(5)
    first, second = compressed(gltf, stream()), compressed(gltf, stream(far))
    gltf.scene([first, second])
    gltf.json["nodes"].append({"mesh": 0, "translation": [0, 0, 20]})
    gltf.json["scenes"][0]["nodes"] = [0, 1]
    mesh = gltf.load(tmp_path)
    assert len(mesh.faces) == 8
    assert mesh.positions.min(axis=0).tolist() == [0, 0, 0]
    np.testing.assert_allclose(mesh.positions.max(axis=0), [6, 6, 25], atol=1e-4)


def test_strips_come_as_triangles(tmp_path: Path) -> None:
    expect_square(square(mode=5).load(tmp_path))


def test_joints_and_weights(tmp_path: Path) -> None:
    gltf = square(names=tuple(IDS))
    gltf.json["nodes"][0]["skin"] = 0
    gltf.json["nodes"].append({"scale": [2, 2, 2]})
    gltf.json["skins"] = [{"joints": [1]}]
    mesh = gltf.load(tmp_path)
    np.testing.assert_allclose(mesh.positions.max(axis=0), [2, 2, 0], atol=1e-4)


def test_uncompressed_accessors_are_overridden(tmp_path: Path) -> None:
    gltf = square()
    other = gltf.accessor(POSITIONS * 100)
    gltf.json["accessors"][0] = gltf.json["accessors"][other]
    expect_square(gltf.load(tmp_path))


def test_counts_and_boxes_that_are_not_so_are_said(tmp_path: Path) -> None:
    gltf = square()
    positions, indices = gltf.json["accessors"][0], gltf.json["accessors"][2]
    positions |= {"min": [0, 0, 0], "max": [0.5, 1, 0]}
    gltf.json["accessors"][1]["count"] = 3
    indices["count"] = 9
    mesh = gltf.load(tmp_path)
    expect_square(mesh)
    assert mesh.warnings == (
        "a.glb: accessors[0]: its Draco data leave the box that min and max say",
        "a.glb: accessors[1]: says 3 elements, its Draco data hold 4",
        "a.glb: accessors[2]: says 9 indices, its Draco data hold 6",
    )


def test_a_box_that_is_so_is_not(tmp_path: Path) -> None:
    gltf = square()
    gltf.json["accessors"][0] |= {"min": [0, 0, 0], "max": [1, 1, 0]}
    assert gltf.load(tmp_path).warnings == ()


def broken(kind: str) -> Gltf:
    gltf = square(b"DRACO" + bytes(40) if kind == "data" else None)
    primitive = gltf.json["meshes"][0]["primitives"][0]
    extension = primitive["extensions"][DRACO]
    if kind == "id":
        extension["attributes"]["POSITION"] = 4
    elif kind == "view":
        extension["bufferView"] = 3
    elif kind == "width":
        extension["attributes"]["POSITION"] = IDS["TEXCOORD_0"]
    elif kind == "type":
        gltf.json["accessors"][0]["componentType"] = 5121
        gltf.data = square(stream(POSITIONS * np.float32(0.5))).data
    elif kind == "points":
        gltf.data = DracoPy.encode(POSITIONS).ljust(len(gltf.data), b"\0")
    elif kind == "shared":
        another = compressed(gltf, stream(POSITIONS * np.float32(2)))
        another["attributes"] = primitive["attributes"]
        gltf.json["meshes"][0]["primitives"].append(another)
    return gltf


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("data", "expected data of Draco, found"),
        ("id", "expected an attribute of the unique id 4 for POSITION, found [5, 7, 8, 9]"),
        ("view", "bufferViews: expected an index below 1, found 3"),
        ("width", "accessors[0]: expected 3 numbers in each element, found (2,)"),
        ("type", "accessors[0]: expected numbers that fit uint8, found 'float32'"),
        ("points", "expected data of Draco, found 'a point cloud'"),
        ("shared", "accessors[0]: expected the same values by all that use it"),
    ],
)
def test_what_does_not_fit_is_named(kind: str, said: str) -> None:
    error = str(outcome(read_gltf, broken(kind).glb(), "a.glb", NOWHERE))
    assert error.startswith("a.glb: ")
    assert said in error


@pytest.mark.slow
def test_damaged_data_give_a_mesh_or_a_sentence() -> None:
    rng = np.random.default_rng(1)
    for _ in range(12):
        gltf = square()
        data = bytearray(gltf.data)
        data[rng.integers(len(data))] = rng.integers(256)
        gltf.data = bytes(data)
        found = outcome(read_gltf, gltf.glb(), "a.glb", NOWHERE)
        assert isinstance(found, TexturedMesh) or str(found).startswith("a.glb: ")


def without(monkeypatch: pytest.MonkeyPatch) -> None:
    def find(name: str) -> ModuleSpec | None:
        return None if name == "DracoPy" else find_spec(name)

    for module in (extras, gltf_draco):
        monkeypatch.setattr(module, "find_spec", find)


def test_without_the_package_a_sentence_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    without(monkeypatch)
    with pytest.raises(NispError, match=r"a\.glb: meshes\[0\].*pip install 'nispcodec\[gltf\]'"):
        read_gltf(square().glb(), "a.glb", NOWHERE)


def test_without_the_package_uncompressed_accessors_are_taken(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    gltf = square()
    uvs = POSITIONS[:, :2]
    whole = [gltf.accessor(POSITIONS), gltf.accessor(uvs), gltf.accessor(FACES.reshape(-1), "<u2")]
    for place, accessor in enumerate(whole):
        gltf.json["accessors"][place] = gltf.json["accessors"][accessor]
    without(monkeypatch)
    expect_square(gltf.load(tmp_path))
