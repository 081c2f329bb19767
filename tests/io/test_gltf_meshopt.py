from __future__ import annotations

from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import meshoptimizer
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core import extras
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.io.folder import Folder
from nispcodec.io.read import gltf_buffers
from nispcodec.io.read.gltf import read_gltf
from nispcodec.io.read.gltf_json import parse_json
from tests.io.files import Gltf, outcome

EXT, KHR = "EXT_meshopt_compression", "KHR_meshopt_compression"
POSITIONS = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.5)], "<f4")
UVS = np.array([(0, 0), (1, 0), (0, 1), (1, 1)], "<f4")
FACES = [0, 1, 2, 2, 1, 3]
NOWHERE = Folder(Path("/nonexistent"))
ENCODERS = {
    "TRIANGLES": meshoptimizer.encode_index_buffer,
    "INDICES": meshoptimizer.encode_index_sequence,
}


class Compressed(Gltf):
    """A document of compressed buffer views, which stand in a second buffer without bytes."""

    def __init__(self, extension: str = EXT) -> None:
        super().__init__()
        self.extension = extension
        fallback = {extension: {"fallback": True}}
        self.other_buffers = [{"byteLength": 0, "extensions": fallback}]
        self.json["extensionsRequired"] = [extension]

    def packed(self, data: bytes, raw: int, **how: Any) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        stored = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **how}
        self.data += data
        fallback = self.other_buffers[0]
        view = {"buffer": 1, "byteOffset": fallback["byteLength"], "byteLength": raw}
        self.json["bufferViews"].append({**view, "extensions": {self.extension: stored}})
        fallback["byteLength"] += raw
        return len(self.json["bufferViews"]) - 1

    def vertices(self, array: AnyArray, **more: Any) -> int:
        how = {"mode": "ATTRIBUTES", "count": len(array), "byteStride": array[0].nbytes}
        data = meshoptimizer.encode_vertex_buffer(array)
        view = self.packed(data, array.nbytes, **how, **more)
        kind = f"VEC{array.shape[1]}"
        self.json["accessors"].append(
            {"bufferView": view, "componentType": 5126, "count": len(array), "type": kind}
        )
        return len(self.json["accessors"]) - 1

    def indices(self, mode: str, size: int = 4) -> int:
        data = ENCODERS[mode](np.array(FACES, np.uint32))
        how = {"mode": mode, "count": len(FACES), "byteStride": size}
        accessor = {
            "bufferView": self.packed(data, len(FACES) * size, **how),
            "componentType": {2: 5123, 4: 5125}[size],
            "count": len(FACES),
            "type": "SCALAR",
        }
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1


def square(extension: str = EXT, mode: str = "TRIANGLES", size: int = 4, **more: Any) -> Compressed:
    gltf = Compressed(extension)
    attributes = {"POSITION": gltf.vertices(POSITIONS, **more), "TEXCOORD_0": gltf.vertices(UVS)}
    primitive = {"attributes": attributes, "indices": gltf.indices(mode, size)}
    gltf.scene([primitive])
    return gltf


def expect_square(mesh: TexturedMesh) -> None:
    order = np.array(FACES).reshape(-1, 3)
    expected = np.sort(POSITIONS[order].reshape(2, -1), axis=0)
    np.testing.assert_array_equal(np.sort(mesh.corners.reshape(2, -1), axis=0), expected)
    np.testing.assert_array_equal(mesh.corner_uvs[..., 0], mesh.corners[..., 0])
    np.testing.assert_array_equal(mesh.corner_uvs[..., 1], 1 - mesh.corners[..., 1])


@pytest.mark.parametrize("extension", [EXT, KHR])
@pytest.mark.parametrize("mode", ["TRIANGLES", "INDICES"])
@pytest.mark.parametrize("size", [2, 4])
def test_views_of_every_mode_are_decompressed(
    tmp_path: Path, extension: str, mode: str, size: int
) -> None:
    mesh = square(extension, mode, size).load(tmp_path)
    expect_square(mesh)
    assert mesh.warnings == ()


@pytest.mark.parametrize("version", [0, 1])
def test_both_versions_of_the_vertex_codec(tmp_path: Path, version: int) -> None:
    meshoptimizer.encode_vertex_version(version)
    try:
        gltf = square(KHR)
    finally:
        meshoptimizer.encode_vertex_version(1)
    expect_square(gltf.load(tmp_path))


def test_exponential_filter(tmp_path: Path) -> None:
    # An exponent of eight bits above a mantissa of 24: 3 * 2^-1.
    stored = np.full((4, 3), (0xFF << 24) | 3, np.uint32)
    stored[1:, 0] = 2**24 - 4 | 0x02 << 24  # -4 * 2^2
    stored[2:, 1] = 0
    gltf = square()
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = gltf.vertices(
        stored.view("<f4"), filter="EXPONENTIAL"
    )
    mesh = gltf.load(tmp_path)
    assert set(mesh.positions[:, 0].tolist()) == {1.5, -16.0}
    assert set(mesh.positions[:, 1].tolist()) == {1.5, 0.0}


def test_octahedral_and_quaternion_filters() -> None:
    gltf = Compressed()
    # The first two are a direction, the third is the length 1; the fourth stays.
    directions = np.array([(0, 0, 127, 5), (127, 0, 127, 6)], np.int8).view("<f4")
    gltf.vertices(directions, filter="OCTAHEDRAL")
    # The last number says which component is left out, the largest, and how fine the others are.
    turns = np.array([(0, 0, 0, 4095)], "<i2").view("<f4")
    gltf.vertices(turns, filter="QUATERNION")
    views = buffers_of(gltf)
    found = np.frombuffer(views.view(0), np.int8).reshape(-1, 4)
    assert found.tolist() == [[0, 0, 127, 5], [127, 0, 0, 6]]
    assert np.frombuffer(views.view(1), "<i2").tolist() == [0, 0, 0, 32767]


def buffers_of(gltf: Gltf) -> gltf_buffers.Buffers:
    text, binary = gltf_buffers.split_glb(gltf.glb(), "a.glb", [])
    return gltf_buffers.Buffers(parse_json(text, "a.glb"), binary, NOWHERE)


@pytest.mark.parametrize(
    ("view", "change", "said"),
    [
        (0, {"mode": "POINTS"}, "expected a mode of ATTRIBUTES, TRIANGLES, INDICES"),
        (0, {"filter": "COLOR"}, "expected a filter of NONE, OCTAHEDRAL"),
        (2, {"filter": "EXPONENTIAL"}, "and NONE for indices, found 'EXPONENTIAL'"),
        (0, {"byteStride": 10}, "expected a byteStride for ATTRIBUTES and NONE, found 10"),
        (0, {"filter": "QUATERNION"}, "expected a byteStride for ATTRIBUTES and QUATERNION"),
        (0, {"count": 10**9}, "expected at most"),
        (0, {"count": 5}, "expected count times byteStride to be 48, found 60"),
        (2, {"count": 5}, "expected a multiple of 3 indices, found 5"),
        (0, {"byteLength": 9}, "expected data of meshoptimizer"),
        (2, {"byteLength": 9}, "expected data of meshoptimizer"),
        (0, {"byteLength": 10**6}, "expected an end within"),
        (0, {"buffer": 1}, "buffers[1]: expected a binary file"),
    ],
)
def test_what_does_not_fit_is_named(view: int, change: dict[str, Any], said: str) -> None:
    gltf = square()
    gltf.json["bufferViews"][view]["extensions"][EXT] |= change
    error = str(outcome(read_gltf, gltf.glb(), "a.glb", NOWHERE))
    assert error.startswith("a.glb: ")
    assert said in error


@given(st.integers(0, 400), st.integers(0, 255), st.sampled_from(["TRIANGLES", "INDICES"]))
@settings(max_examples=200)
def test_damaged_data_give_a_mesh_or_a_sentence(at: int, value: int, mode: str) -> None:
    gltf = square(mode=mode, filter="EXPONENTIAL")
    data = bytearray(gltf.data)
    data[at % len(data)] = value
    gltf.data = bytes(data)
    found = outcome(read_gltf, gltf.glb(), "a.glb", NOWHERE)
    assert isinstance(found, TexturedMesh) or str(found).startswith("a.glb: ")


def without(monkeypatch: pytest.MonkeyPatch, package: str) -> None:
    def find(name: str) -> ModuleSpec | None:
        return None if name == package else find_spec(name)

    for module in (extras, gltf_buffers):
        monkeypatch.setattr(module, "find_spec", find)


def test_without_the_package_a_sentence_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    without(monkeypatch, "meshoptimizer")
    with pytest.raises(
        NispError, match=r"a\.glb: bufferViews\[0\].*pip install 'nispcodec\[gltf\]'"
    ):
        read_gltf(square().glb(), "a.glb", NOWHERE)


def test_without_the_package_uncompressed_views_are_taken_where_the_file_has_them(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    gltf = square()
    raw = POSITIONS.tobytes() + UVS.tobytes() + np.array(FACES, "<u4").tobytes()
    (tmp_path / "raw.bin").write_bytes(raw)
    gltf.other_buffers[0]["uri"] = "raw.bin"
    without(monkeypatch, "meshoptimizer")
    expect_square(gltf.load(tmp_path))
