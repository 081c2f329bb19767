from __future__ import annotations

import base64
import json
import math
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.load import load_mesh
from nispcodec.io.read.gltf import read_gltf
from tests.io.files import Gltf, image, outcome

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
UVS = [(0, 0), (0.25, 0.5), (2, -1)]
NOWHERE = Folder(Path("/nonexistent"))


def triangle(gltf: Gltf, uvs: bool = True, **more: Any) -> dict[str, Any]:
    attributes = {"POSITION": gltf.accessor(CORNERS)}
    if uvs:
        attributes["TEXCOORD_0"] = gltf.accessor(UVS)
    return {"attributes": attributes, "indices": gltf.accessor([0, 1, 2], "u1"), **more}


def one_triangle(**node: Any) -> Gltf:
    gltf = Gltf()
    return gltf.scene([triangle(gltf)], **node)


def textured(info: dict[str, Any] | None = None, **material: Any) -> Gltf:
    """A triangle whose material has a base color map with this textureInfo."""
    gltf = Gltf()
    gltf.json["images"] = [{"bufferView": gltf.view(image()), "mimeType": "image/png"}]
    gltf.json["textures"] = [{"source": 0}]
    pbr = {"baseColorTexture": {"index": 0, **(info or {})}}
    gltf.json["materials"] = [{"name": "m", "pbrMetallicRoughness": pbr, **material}]
    return gltf.scene([triangle(gltf, material=0)])


def test_positions_faces_and_flipped_uvs(tmp_path: Path) -> None:
    mesh = one_triangle().load(tmp_path)
    assert mesh.corners.tolist() == [[list(corner) for corner in CORNERS]]
    assert mesh.corner_uvs.tolist() == [[[0, 1], [0.25, 0.5], [2, 2]]]
    assert mesh.warnings == ()
    assert mesh.name == "a"


def test_a_gltf_with_data_uris_or_external_files_equals_the_glb(tmp_path: Path) -> None:
    glb = one_triangle().load(tmp_path)
    gltf = one_triangle()
    (tmp_path / "b.gltf").write_bytes(gltf.text())
    document = json.loads(gltf.text())
    document["buffers"][0]["uri"] = "my%20data.bin"
    (tmp_path / "my data.bin").write_bytes(gltf.data)
    (tmp_path / "c.gltf").write_text(json.dumps(document))
    for name in ("b.gltf", "c.gltf"):
        mesh = load_mesh(tmp_path / name)
        np.testing.assert_array_equal(mesh.corners, glb.corners)
        np.testing.assert_array_equal(mesh.corner_uvs, glb.corner_uvs)


def test_without_indices_and_without_uvs(tmp_path: Path) -> None:
    gltf = Gltf()
    primitive = triangle(gltf, uvs=False)
    del primitive["indices"]
    mesh = gltf.scene([primitive]).load(tmp_path)
    assert mesh.faces.tolist() == [[0, 1, 2]]
    assert not mesh.has_uv.any()


@pytest.mark.parametrize(
    ("dtype", "top", "more"),
    [("u1", 255, {}), ("<u2", 65535, {}), ("i1", 127, {}), ("<i2", 32767, {})],
)
def test_normalized_integers(tmp_path: Path, dtype: str, top: int, more: dict[str, Any]) -> None:
    gltf = Gltf()
    primitive = triangle(gltf)
    stored = [(0, top), (top, 0), (top // 3, 0)]
    accessor = gltf.accessor(stored, dtype, normalized=True, **more)
    primitive["attributes"]["TEXCOORD_0"] = accessor
    mesh = gltf.scene([primitive]).load(tmp_path)
    expected = np.array(stored) / top
    np.testing.assert_array_equal(mesh.corner_uvs[0, :, 0], expected[:, 0])
    np.testing.assert_array_equal(mesh.corner_uvs[0, :, 1], 1 - expected[:, 1])


def test_quantized_positions(tmp_path: Path) -> None:
    gltf = Gltf()
    primitive = triangle(gltf)
    primitive["attributes"]["POSITION"] = gltf.accessor(np.array(CORNERS) * 100, "<u2")
    gltf.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    mesh = gltf.scene([primitive], scale=[0.01, 0.01, 0.01]).load(tmp_path)
    np.testing.assert_allclose(mesh.corners[0], CORNERS)


def test_interleaved_attributes(tmp_path: Path) -> None:
    gltf = Gltf()
    rows = np.hstack([CORNERS, UVS, [[9.0]] * 3]).astype("<f4")
    view = gltf.view(rows.tobytes(), byteStride=24)
    common = {"bufferView": view, "componentType": 5126, "count": 3}
    gltf.json["accessors"] = [
        {**common, "type": "VEC3"},
        {**common, "type": "VEC2", "byteOffset": 12},
    ]
    mesh = gltf.scene([{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}}]).load(tmp_path)
    np.testing.assert_array_equal(mesh.corners[0], CORNERS)
    np.testing.assert_array_equal(mesh.corner_uvs[0, :, 0], np.array(UVS)[:, 0])


@pytest.mark.parametrize("base", [True, False])
def test_sparse_accessors(tmp_path: Path, base: bool) -> None:
    gltf = Gltf()
    sparse = {
        "count": 2,
        "indices": {"bufferView": gltf.view(bytes([1, 2])), "componentType": 5121},
        "values": {"bufferView": gltf.view(np.array(CORNERS[1:], dtype="<f4").tobytes())},
    }
    accessor = gltf.accessor([(0, 0, 0), (7, 7, 7), (8, 8, 8)], sparse=sparse)
    if not base:
        del gltf.json["accessors"][accessor]["bufferView"]
    mesh = gltf.scene([{"attributes": {"POSITION": accessor}}]).load(tmp_path)
    np.testing.assert_array_equal(mesh.corners[0], CORNERS)


@pytest.mark.parametrize(
    ("mode", "expected"),
    [
        (4, [[0, 1, 2], [3, 4, 5]]),
        (5, [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]),
        (6, [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]]),
    ],
)
def test_lists_strips_and_fans(tmp_path: Path, mode: int, expected: list[list[int]]) -> None:
    gltf = Gltf()
    points = np.random.default_rng(0).normal(size=(6, 3))
    primitive = {"attributes": {"POSITION": gltf.accessor(points)}, "mode": mode}
    assert gltf.scene([primitive]).load(tmp_path).faces.tolist() == expected


def test_points_and_lines_are_left_out_by_name(tmp_path: Path) -> None:
    gltf = Gltf()
    lines = {"attributes": {"POSITION": gltf.accessor(CORNERS)}, "mode": 1}
    mesh = gltf.scene([triangle(gltf), lines]).load(tmp_path)
    assert len(mesh.faces) == 1
    assert mesh.warnings == (
        "a.glb: meshes[0].primitives[1]: left out, not a primitive of triangles",
    )


def test_node_transforms_apply_from_the_root_down(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    gltf = one_triangle(translation=[0, 0, 5], scale=[2, 2, 2])
    gltf.json["nodes"].append({"children": [0], "rotation": [0, 0, half, half]})
    gltf.json["nodes"].append(
        {"children": [1], "matrix": [*np.eye(4).reshape(-1)[:12], 1, 0, 0, 1]}
    )
    gltf.json["scenes"] = [{"nodes": [2]}]
    mesh = gltf.load(tmp_path)
    np.testing.assert_allclose(mesh.corners[0], [(1, 0, 5), (1, 2, 5), (-1, 0, 5)], atol=1e-12)


def test_mirroring_transforms_flip_the_winding(tmp_path: Path) -> None:
    mesh = one_triangle(scale=[1, 1, -1]).load(tmp_path)
    a, b, c = mesh.corners[0]
    assert np.cross(b - a, c - a)[2] < 0
    assert mesh.corner_uvs[0].tolist() == [[0, 1], [2, 2], [0.25, 0.5]]


def test_instances_of_a_mesh(tmp_path: Path) -> None:
    gltf = one_triangle()
    gltf.json["nodes"].append({"mesh": 0, "translation": [10, 0, 0]})
    gltf.json["scenes"] = [{"nodes": [0, 1]}]
    mesh = gltf.load(tmp_path)
    assert mesh.corners[:, 0, 0].tolist() == [0, 10]


def test_a_file_without_scenes_shows_its_root_nodes(tmp_path: Path) -> None:
    gltf = one_triangle()
    del gltf.json["scenes"]
    assert len(gltf.load(tmp_path).faces) == 1


def test_only_the_default_scene_counts(tmp_path: Path) -> None:
    gltf = one_triangle()
    gltf.json["nodes"].append({"mesh": 0, "translation": [10, 0, 0]})
    gltf.json.update(scenes=[{"nodes": [0]}, {"nodes": [1]}], scene=1)
    mesh = gltf.load(tmp_path)
    assert mesh.positions.tolist() == [[x + 10, y, z] for x, y, z in CORNERS]
    said = "left out 1 node with a mesh that scene {}, which is shown, does not have"
    assert mesh.warnings == (f"a.glb: {said.format(1)}",)
    del gltf.json["scene"]
    mesh = gltf.load(tmp_path)
    assert mesh.positions[0].tolist() == [0, 0, 0]
    assert mesh.warnings == (f"a.glb: {said.format(0)}",)


def test_without_a_default_scene_the_first_that_has_nodes_is_shown(tmp_path: Path) -> None:
    gltf = one_triangle()
    gltf.json["scenes"] = [{}, {"nodes": [0]}]
    mesh = gltf.load(tmp_path)
    assert (len(mesh.faces), mesh.warnings) == (1, ())


def test_a_scene_that_shows_nothing_is_refused_in_a_sentence(tmp_path: Path) -> None:
    gltf = one_triangle()
    expected = r"a.glb: expected a visible mesh of triangles in the scene, found none"
    gltf.json.update(scenes=[{}, {"nodes": [0]}], scene=0)
    with pytest.raises(MeshError, match=rf"^{expected} \(a.glb: left out 1 node with a mesh that"):
        gltf.load(tmp_path)
    del gltf.json["nodes"], gltf.json["scenes"], gltf.json["scene"]
    with pytest.raises(MeshError, match=f"^{expected}$"):
        gltf.load(tmp_path)


def test_primitives_share_vertices_and_keep_their_materials(tmp_path: Path) -> None:
    gltf = Gltf()
    first = triangle(gltf, material=1)
    second = {**first, "indices": gltf.accessor([0, 2, 1], "<u4"), "material": 0}
    gltf.json["materials"] = [{"name": "zero"}, {"name": "one"}, {"name": "unused"}]
    mesh = gltf.scene([first, second, {**first, "indices": gltf.accessor([1, 2, 0], "u1")}])
    del mesh.json["meshes"][0]["primitives"][2]["material"]
    loaded = mesh.load(tmp_path)
    assert len(loaded.positions) == 3
    assert loaded.face_materials.tolist() == [0, 1, 2]
    assert [material.name for material in loaded.materials] == ["one", "zero", "material"]


def test_material_values(tmp_path: Path) -> None:
    gltf = textured(
        alphaMode="MASK", alphaCutoff=0.25, doubleSided=True, emissiveFactor=[0.5, 0, 1],
        normalTexture={"index": 0, "scale": 0.5}, occlusionTexture={"index": 0, "strength": 0.25},
        emissiveTexture={"index": 0},
    )  # fmt: skip
    gltf.json["materials"][0]["pbrMetallicRoughness"].update(
        baseColorFactor=[0.1, 0.2, 0.3, 0.4], metallicFactor=0.5, roughnessFactor=0.75,
        metallicRoughnessTexture={"index": 0},
    )  # fmt: skip
    mesh = gltf.load(tmp_path)
    (made,) = mesh.materials
    assert made.base_color == (0.1, 0.2, 0.3, 0.4)
    assert (made.metallic, made.roughness) == (0.5, 0.75)
    assert (made.alpha_mode, made.alpha_cutoff, made.double_sided) == ("mask", 0.25, True)
    assert made.emissive == (0.5, 0.0, 1.0)
    assert set(made.maps) == {
        "base_color", "normal", "metallic_roughness", "occlusion", "emissive",
    }  # fmt: skip
    assert (made.maps["normal"].strength, made.maps["occlusion"].strength) == (0.5, 0.25)
    assert [texture.data for texture in mesh.textures] == [image()]


def test_defaults_are_those_of_gltf(tmp_path: Path) -> None:
    gltf = Gltf()
    gltf.json["materials"] = [{}]
    made = gltf.scene([triangle(gltf, material=0)]).load(tmp_path).materials[0]
    assert (made.metallic, made.roughness, made.base_color) == (1.0, 1.0, (1.0, 1.0, 1.0, 1.0))


def test_samplers(tmp_path: Path) -> None:
    gltf = textured()
    gltf.json["samplers"] = [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}]
    gltf.json["textures"][0]["sampler"] = 0
    used = gltf.load(tmp_path).materials[0].maps["base_color"]
    assert (used.wrap, used.filter) == (("clamp", "mirror"), "nearest")


def test_texture_transform_applies_before_the_flip(tmp_path: Path) -> None:
    moved = {"offset": [0, 1], "rotation": math.pi / 2, "scale": [0.5, 0.5]}
    mesh = textured({"extensions": {"KHR_texture_transform": moved}}).load(tmp_path)
    # The extension's own example: the lower left quadrant of the image.
    expected = [(0.5 * v, 1 - (1 - 0.5 * u)) for u, v in UVS]
    np.testing.assert_allclose(mesh.corner_uvs[0], expected, atol=1e-12)


def test_texcoord_chooses_the_uvs(tmp_path: Path) -> None:
    gltf = textured({"texCoord": 1})
    other = [(0.5, 0.5), (1, 0), (0, 0)]
    attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["TEXCOORD_1"] = gltf.accessor(other)
    mesh = gltf.load(tmp_path)
    assert mesh.corner_uvs[0].tolist() == [[u, 1 - v] for u, v in other]


@pytest.mark.parametrize(
    "info", [{"texCoord": 1}, {"extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}]
)
def test_maps_of_other_uvs_than_the_base_colors_are_left_out(
    tmp_path: Path, info: dict[str, Any]
) -> None:
    mesh = textured(occlusionTexture={"index": 0, **info}, emissiveTexture={"index": 0}).load(
        tmp_path
    )
    assert mesh.corner_uvs[0, 1].tolist() == [0.25, 0.5]
    assert set(mesh.materials[0].maps) == {"base_color", "emissive"}
    assert mesh.warnings == (
        "a.glb: materials[0]: left out the maps for occlusion: "
        "they use other texture coordinates than base_color",
    )


def test_one_accessor_under_two_numbers_is_one_set_of_uvs(tmp_path: Path) -> None:
    gltf = textured(occlusionTexture={"index": 0, "texCoord": 1})
    attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["TEXCOORD_1"] = attributes["TEXCOORD_0"]
    mesh = gltf.load(tmp_path)
    assert set(mesh.materials[0].maps) == {"base_color", "occlusion"}
    assert mesh.corner_uvs[0].tolist() == [[u, 1 - v] for u, v in UVS]
    assert mesh.warnings == ()
    attributes["TEXCOORD_1"] = gltf.accessor(UVS[::-1])
    assert set(gltf.load(tmp_path).materials[0].maps) == {"base_color"}


@pytest.mark.parametrize("there", [True, False])
def test_missing_uvs_are_never_lost_without_a_word(tmp_path: Path, there: bool) -> None:
    gltf = textured({"texCoord": 1})
    if not there:
        del gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    mesh = gltf.load(tmp_path)
    assert mesh.has_uv.all() == there
    assert "no TEXCOORD_1, which the material looks up" in mesh.warnings[0]
    assert ("TEXCOORD_0 is taken" if there else "maps are not shown") in mesh.warnings[0]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("unusable", [b"\0\0\xc0\x7f", b"\1\0\x80\x7f", b"\0\0\x80\x7f"])
def test_a_face_with_unusable_uvs_has_none(tmp_path: Path, unusable: bytes) -> None:
    gltf = Gltf()
    primitive = triangle(gltf)
    primitive["attributes"] = {
        "POSITION": gltf.accessor([*CORNERS, (0, 0, 1)]),
        "TEXCOORD_0": gltf.accessor([*UVS, (9.5, 0)]),
    }
    gltf.data = gltf.data.replace(np.array(9.5, "<f4").tobytes(), unusable)
    primitive["indices"] = gltf.accessor([0, 1, 2, 0, 2, 3], "u1")
    mesh = gltf.scene([primitive]).load(tmp_path)
    assert mesh.has_uv.tolist() == [True, False]
    assert "texture coordinates of 1 face(s) are no finite numbers" in mesh.warnings[0]


def test_an_unusable_position_that_no_face_has_costs_itself_alone(tmp_path: Path) -> None:
    gltf = Gltf()
    moves = [(0, 0, 1), (0, 0, 1), (math.nan, 0, 0), (0, 0, 1)]
    primitive = {
        "attributes": {"POSITION": gltf.accessor([*CORNERS[:2], (0, math.inf, 0), CORNERS[2]])},
        "indices": gltf.accessor([0, 1, 3], "u1"),
        "targets": [{"POSITION": gltf.accessor(moves)}],
    }
    gltf.scene([primitive, primitive])
    gltf.json["meshes"][0]["weights"] = [1]
    mesh = gltf.load(tmp_path)
    assert mesh.corners[0].tolist() == [[x, y, 1] for x, y, _ in CORNERS]
    said = "left out 1 vertex without finite coordinates, which no face has"
    assert mesh.warnings[:2] == (f"a.glb: accessors[0]: {said}", f"a.glb: accessors[2]: {said}")
    primitive["indices"] = gltf.accessor([0, 1, 2], "u1")
    with pytest.raises(MeshError, match=r"accessors\[0\]: expected finite numbers in element 2"):
        gltf.load(tmp_path)


def test_factors_that_are_not_finite_are_left_out(tmp_path: Path) -> None:
    gltf = textured(emissiveFactor=[math.inf, 0, 0])
    gltf.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = math.nan
    mesh = gltf.load(tmp_path)
    assert (mesh.materials[0].metallic, mesh.materials[0].emissive) == (1.0, (0.0, 0.0, 0.0))
    assert "metallicFactor, emissiveFactor no finite numbers" in mesh.warnings[0]


@pytest.mark.parametrize("name", ["a\tb", "a\x7fb", "a\ud800b"])
def test_names_that_are_no_text_become_some(tmp_path: Path, name: str) -> None:
    gltf = textured()
    gltf.json["materials"][0]["name"] = name
    mesh = gltf.load(tmp_path)
    assert mesh.materials[0].name == "a_b"
    assert mesh.warnings[0].endswith("control characters in its name became '_'")


def test_instances_by_extension(tmp_path: Path) -> None:
    gltf = one_triangle(translation=[0, 0, 5])
    half = math.sqrt(0.5)
    attributes = {
        "TRANSLATION": gltf.accessor([(0, 0, 0), (3, 0, 0)]),
        "ROTATION": gltf.accessor([(0, 0, 0, 1), (0, 0, half, half)]),
        "SCALE": gltf.accessor([(1, 1, 1), (2, 2, -2)]),
    }
    gltf.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    gltf.json["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    mesh = gltf.load(tmp_path)
    expected = [[(0, 0, 5), (1, 0, 5), (0, 1, 5)], [(3, 0, 5), (1, 0, 5), (3, 2, 5)]]
    np.testing.assert_allclose(mesh.corners, expected, atol=1e-6)
    np.testing.assert_array_equal(mesh.corner_uvs[1], mesh.corner_uvs[0][[0, 2, 1]])


def test_too_many_instances_are_refused_before_memory_is_taken(tmp_path: Path) -> None:
    gltf = one_triangle()
    zeros = gltf.accessor(CORNERS)
    gltf.json["accessors"][zeros].update(count=9_999_999)
    del gltf.json["accessors"][zeros]["bufferView"]
    attributes = {"SCALE": zeros}
    gltf.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    with pytest.raises(MeshError, match="at most 100000 instances"):
        gltf.load(tmp_path)
    gltf.json["accessors"][zeros].update(count=100_000)
    many = {"bufferView": gltf.view(bytes(12 * 300)), "componentType": 5126}
    gltf.json["accessors"][0].update(count=300, **many)
    with pytest.raises(MeshError, match="at most 20000000 faces and vertices in all"):
        gltf.load(tmp_path)


def test_hidden_nodes_and_their_children_are_left_out(tmp_path: Path) -> None:
    gltf = one_triangle()
    hidden = {"KHR_node_visibility": {"visible": False}}
    gltf.json["nodes"] += [{"extensions": hidden, "children": [2]}, {"mesh": 0}]
    gltf.json["scenes"] = [{"nodes": [0, 1]}]
    mesh = gltf.load(tmp_path)
    assert len(mesh.faces) == 1
    assert mesh.warnings == ("a.glb: left out 1 node(s) of visibility false",)
    gltf.json["scenes"] = [{"nodes": [1]}]
    with pytest.raises(MeshError, match=r"a visible mesh .*visibility false"):
        gltf.load(tmp_path)


def skinned_triangle(joints: Any, weights: Any) -> Gltf:
    """A triangle of two joints: one twice as large, the other at x = 10 and turned about x."""
    gltf = Gltf()
    half = math.sqrt(0.5)
    primitive = triangle(gltf)
    primitive["attributes"]["JOINTS_0"] = gltf.accessor(joints, "u1")
    primitive["attributes"]["WEIGHTS_0"] = gltf.accessor(weights)
    inverse = np.tile(np.eye(4), (2, 1, 1))
    inverse[0, 0, 3] = -1  # column-major in the file
    columns = inverse.transpose(0, 2, 1).reshape(2, 16)
    gltf.scene([primitive], skin=0, translation=[99, 0, 0])
    gltf.json["nodes"] += [
        {"scale": [2, 2, 2], "children": [2]},
        {"translation": [5, 0, 0], "rotation": [half, 0, 0, half]},
    ]
    gltf.json["skins"] = [{"joints": [1, 2], "inverseBindMatrices": gltf.accessor(columns)}]
    return gltf


def test_skins_place_their_vertices_by_joints_and_weights(tmp_path: Path) -> None:
    joints = [(0, 1, 0, 0), (1, 0, 0, 0), (1, 0, 9, 0)]
    weights = [(1, 0, 0, 0), (0.5, 0.5, 0, 0), (2, 0, 0, 0)]
    mesh = skinned_triangle(joints, weights).load(tmp_path)
    np.testing.assert_allclose(mesh.corners[0], [(-2, 0, 0), (6, 0, 0), (10, 0, 2)], atol=1e-6)
    assert "bind pose" in mesh.warnings[0]


def test_skins_of_more_than_four_joints_a_vertex(tmp_path: Path) -> None:
    gltf = skinned_triangle([(0, 0, 0, 0)] * 3, [(0.5, 0, 0, 0)] * 3)
    attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_1"] = gltf.accessor([(1, 1, 1, 1)] * 3, "<u2")
    attributes["WEIGHTS_1"] = gltf.accessor([(0.125, 0.125, 0.125, 0.125)] * 3)
    mesh = gltf.load(tmp_path)
    expected = [(4, 0, 0), (6, 0, 0), (4, 1, 1)]
    np.testing.assert_allclose(mesh.corners[0], expected, atol=1e-6)
    attributes["WEIGHTS_1"] = gltf.accessor([(0.125, 0.125, 0.125, 0.125)] * 2)
    with pytest.raises(MeshError, match="expected 3 joints and weights"):
        gltf.load(tmp_path)


def test_a_vertex_of_an_unknown_joint_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match="expected joints below 2, found 2"):
        skinned_triangle([(2, 0, 0, 0)] * 3, [(1, 0, 0, 0)] * 3).load(tmp_path)


@pytest.mark.parametrize("owner", ["meshes", "nodes"])
def test_morph_targets_at_their_default_weights(tmp_path: Path, owner: str) -> None:
    gltf = one_triangle()
    moved = gltf.accessor([(0, 0, 4), (0, 0, 0), (0, 0, 0)])
    gltf.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": moved}]
    gltf.json["meshes"][0]["weights"] = [0.25]
    gltf.json[owner][0]["weights"] = [0.5]
    mesh = gltf.load(tmp_path)
    assert mesh.corners[0, 0].tolist() == [0, 0, 2]
    assert "morph targets, taking their default weights" in mesh.warnings[0]


def test_a_length_of_zero_is_that_of_the_file(tmp_path: Path) -> None:
    data = one_triangle().glb()
    mesh = read_gltf(data[:8] + bytes(4) + data[12:], "a.glb", NOWHERE)
    assert len(mesh.faces) == 1


@pytest.mark.parametrize("extension", ["EXT_texture_webp", "EXT_texture_avif"])
def test_modern_images(tmp_path: Path, extension: str) -> None:
    gltf = textured()
    data = image(extension[-4:].upper())
    uri = "data:image/x;base64," + base64.b64encode(data).decode()
    gltf.json["images"].append({"uri": uri})
    gltf.json["textures"] = [{"source": 0, "extensions": {extension: {"source": 1}}}]
    gltf.json["extensionsRequired"] = [extension]
    (texture,) = gltf.load(tmp_path).textures
    assert texture.data == data
    assert texture.mime == f"image/{extension[-4:]}"


def test_external_images(tmp_path: Path) -> None:
    gltf = textured()
    gltf.json["images"] = [{"uri": "my%20wood.png"}]
    mesh = gltf.load(tmp_path)
    assert mesh.warnings == ("a.glb: images[0]: image 'my wood.png' not found",)
    assert mesh.materials[0].maps == {}
    (tmp_path / "my wood.png").write_bytes(image())
    mesh = gltf.load(tmp_path)
    assert mesh.textures[0].name == "my wood.png"


def test_an_image_format_we_cannot_read_is_a_warning(tmp_path: Path) -> None:
    gltf = textured()
    gltf.json["textures"] = [{"extensions": {"ACME_texture_magic": {"source": 0}}}]
    mesh = gltf.load(tmp_path)
    assert mesh.warnings == ("a.glb: textures[0]: holds no image that we can read",)


def test_specular_glossiness_becomes_diffuse_and_roughness(tmp_path: Path) -> None:
    gltf = textured()
    glossy = {
        "diffuseFactor": [1, 0, 0, 1],
        "glossinessFactor": 0.75,
        "diffuseTexture": {"index": 0},
    }
    extension = "KHR_materials_pbrSpecularGlossiness"
    gltf.json["materials"] = [{"extensions": {extension: glossy}}]
    mesh = gltf.load(tmp_path)
    (made,) = mesh.materials
    assert (made.base_color, made.metallic, made.roughness) == ((1, 0, 0, 1), 0.0, 0.25)
    assert "base_color" in made.maps
    assert "specular-glossiness" in mesh.warnings[0]


def test_specular_glossiness_counts_where_the_other_is_empty(tmp_path: Path) -> None:
    gltf = textured()
    glossy = {"diffuseFactor": [1, 0, 0, 1], "glossinessFactor": 0.75}
    extensions = {"KHR_materials_pbrSpecularGlossiness": glossy}
    gltf.json["materials"] = [{"pbrMetallicRoughness": {}, "extensions": extensions}]
    (made,) = gltf.load(tmp_path).materials
    assert (made.base_color, made.metallic, made.roughness) == ((1, 0, 0, 1), 0.0, 0.25)


def test_specular_glossiness_has_the_image_where_the_other_has_factors_only(
    tmp_path: Path,
) -> None:
    gltf = textured()
    extension = "KHR_materials_pbrSpecularGlossiness"
    glossy = {"diffuseTexture": {"index": 0}}
    gltf.json["materials"] = [
        {"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {extension: glossy}}
    ]
    mesh = gltf.load(tmp_path)
    assert "base_color" in mesh.materials[0].maps
    assert "specular-glossiness" in mesh.warnings[0]


def test_compressed_textures_give_way_to_their_fallback(tmp_path: Path) -> None:
    gltf = textured()
    extensions = {"KHR_texture_basisu": {"source": 1}}
    gltf.json["textures"] = [{"source": 0, "extensions": extensions}]
    gltf.json["extensionsRequired"] = ["KHR_texture_basisu"]
    assert gltf.load(tmp_path).textures[0].data == image()


def test_what_is_lost_is_said(tmp_path: Path) -> None:
    gltf = one_triangle(skin=0, translation=[5, 0, 0])
    primitive = gltf.json["meshes"][0]["primitives"][0]
    primitive["attributes"]["COLOR_0"] = 0
    primitive["targets"] = [{"POSITION": 0}]
    gltf.json.update(skins=[{"joints": [0]}], animations=[{}])
    gltf.json["materials"] = [{"extensions": {"KHR_materials_clearcoat": {}}}]
    primitive["material"] = 0
    mesh = gltf.load(tmp_path)
    said = " ".join(mesh.warnings)
    for what in ("animations", "bind pose", "vertex colors", "morph targets", "clearcoat"):
        assert what in said
    assert mesh.positions[0].tolist() == [0, 0, 0]


def test_extensions_that_nobody_reads_are_said(tmp_path: Path) -> None:
    gltf = one_triangle()
    gltf.json["extensionsUsed"] = [
        "ACME_magic",
        "KHR_materials_variants",
        "KHR_materials_clearcoat",
        "KHR_texture_transform",
    ]
    assert gltf.load(tmp_path).warnings == (
        "a.glb: left out extension 'ACME_magic'",
        "a.glb: left out extension 'KHR_materials_variants'",
    )


@pytest.mark.parametrize("name", ["KHR_xmp_json_ld", "KHR_animation_pointer"])
def test_extensions_that_change_nothing_at_rest_may_be_required(tmp_path: Path, name: str) -> None:
    gltf = one_triangle()
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = [name]
    assert gltf.load(tmp_path).warnings == ()


def broken(change: str) -> bytes:
    """A document spoilt in one place."""
    gltf = textured()
    primitive = gltf.json["meshes"][0]["primitives"][0]
    spoil: dict[str, Callable[[], object]] = {
        "version": lambda: gltf.json.update(asset={"version": "1.0"}),
        "no asset": lambda: gltf.json.pop("asset"),
        "extension": lambda: gltf.json.update(extensionsRequired=["ACME_magic"]),
        "accessor": lambda: primitive["attributes"].update(POSITION=99),
        "negative": lambda: primitive["attributes"].update(POSITION=-1),
        "type": lambda: primitive["attributes"].update(POSITION="zero"),
        "view end": lambda: gltf.json["bufferViews"][1].update(byteLength=10**9),
        "count": lambda: gltf.json["accessors"][0].update(count=10**12),
        "stride": lambda: gltf.json["bufferViews"][1].update(byteStride=40),
        "zeros": lambda: [gltf.json["accessors"][0].update(count=10**12),
                          gltf.json["accessors"][0].pop("bufferView")],
        "component": lambda: gltf.json["accessors"][0].update(componentType=5124),
        "width": lambda: gltf.json["accessors"][0].update(type="VEC2"),
        "float indices": lambda: primitive.update(indices=0),
        "index": lambda: primitive.update(indices=gltf.accessor([0, 1, 3], "u1")),
        "two indices": lambda: primitive.update(indices=gltf.accessor([0, 1], "u1")),
        "nan": lambda: primitive["attributes"].update(
            POSITION=gltf.accessor([*CORNERS[:2], (0, math.nan, 0)])),
        "cycle": lambda: gltf.json["nodes"][0].update(children=[0]),
        "children": lambda: gltf.json["nodes"][0].update(children="all"),
        "scene": lambda: gltf.json.update(scene=3),
        "matrix": lambda: gltf.json["nodes"][0].update(matrix=[1, 2, 3]),
    }  # fmt: skip
    spoil[change]()
    return gltf.glb()


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ("version", "expected glTF version 2, found '1.0'"),
        ("no asset", "expected a member 'asset'"),
        ("extension", "'ACME_magic'"),
        ("accessor", "a.glb: accessors: expected an index below 3, found 99"),
        ("negative", "attributes.POSITION: expected a non-negative integer, found -1"),
        ("type", "expected a non-negative integer, found 'zero'"),
        ("view end", "bufferViews[1]: expected an end within"),
        ("count", "accessors[0]: expected an end within the 36 bytes of bufferView 1"),
        ("stride", "accessors[0]: expected an end within"),
        ("zeros", "accessors[0]: expected at most"),
        ("component", "expected a componentType of"),
        ("width", "expected type VEC3, found 'VEC2'"),
        ("float indices", "accessors[0]: expected"),
        ("index", "primitives[0]: expected vertex indices below 3, found 3"),
        ("two indices", "left out 2 corner(s)"),
        ("nan", "accessors[3]: expected finite numbers in element 2"),
        ("cycle", "nodes[0]: expected a node with one parent"),
        ("children", "expected node indices in children"),
        ("scene", "scenes: expected an index below 1, found 3"),
        ("matrix", "nodes[0].matrix: expected 16 numbers"),
    ],
)
def test_errors_name_the_place(change: str, expected: str) -> None:
    with pytest.raises(MeshError) as caught:
        read_gltf(broken(change), "a.glb", NOWHERE)
    assert str(caught.value).startswith("a.glb: ")
    assert expected in str(caught.value)


@pytest.mark.parametrize(
    ("name", "rows", "said"),
    [
        ("TEXCOORD_0", UVS[:2], "attributes: expected 3 of TEXCOORD_0, found 2: left out"),
        ("TEXCOORD_0", [[0, 0, 0]] * 3, "expected type VEC2, found 'VEC3': TEXCOORD_0 left out"),
        ("NORMAL", [[0, 0, 1]] * 2, "attributes: expected 3 of NORMAL, found 2: left out"),
        ("NORMAL", [[0, 1]] * 3, "expected type VEC3, found 'VEC2': NORMAL left out"),
    ],
)
def test_an_attribute_that_does_not_fit_costs_itself_alone(
    tmp_path: Path, name: str, rows: list[list[float]], said: str
) -> None:
    gltf = textured()
    primitive = gltf.json["meshes"][0]["primitives"][0]
    primitive["attributes"][name] = gltf.accessor(rows)
    mesh = gltf.load(tmp_path)
    assert mesh.has_uv.all() == (name == "NORMAL")
    assert said in mesh.warnings[0]


@pytest.mark.parametrize(
    ("spoilt", "said"),
    [
        ({"alphaMode": "FOG"}, "materials[0]: expected an alphaMode, found 'fog'"),
        ({"emissiveFactor": [1, 1]}, "emissiveFactor: expected 3 numbers"),
        ({"doubleSided": "yes"}, "doubleSided: expected a boolean"),
        ({"alphaCutoff": "half"}, "alphaCutoff: expected a number"),
        ({"occlusionTexture": {"index": 9}}, "textures: expected an index below"),
    ],
)
def test_a_malformed_member_of_a_material_costs_itself_alone(
    tmp_path: Path, spoilt: dict[str, Any], said: str
) -> None:
    gltf = textured()
    whole = gltf.load(tmp_path).materials[0]
    gltf.json["materials"][0].update(spoilt)
    mesh = gltf.load(tmp_path)
    assert said in " ".join(mesh.warnings)
    assert mesh.materials[0].maps["base_color"] == whole.maps["base_color"]
    assert mesh.materials[0].base_color == whole.base_color
    assert mesh.materials[0].alpha_mode == "opaque"


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        ({"baseColorFactor": [1, 0, 0]}, "baseColorFactor: expected 4 numbers"),
        ({"roughnessFactor": "rough"}, "roughnessFactor: expected a number"),
    ],
)
def test_a_malformed_factor_costs_itself_alone(
    tmp_path: Path, factors: dict[str, Any], said: str
) -> None:
    gltf = textured()
    gltf.json["materials"][0]["pbrMetallicRoughness"] = {"metallicFactor": 0.25, **factors}
    mesh = gltf.load(tmp_path)
    assert said in mesh.warnings[0]
    made = mesh.materials[0]
    assert (made.base_color, made.metallic, made.roughness) == ((1.0, 1.0, 1.0, 1.0), 0.25, 1.0)


def test_factors_beyond_their_range_are_cut_with_a_warning(tmp_path: Path) -> None:
    gltf = textured(emissiveFactor=[3, 0, 0.5], alphaCutoff=2)
    gltf.json["materials"][0]["pbrMetallicRoughness"].update(
        baseColorFactor=[1, 1, 1.5, 1], metallicFactor=-1, roughnessFactor=0.5
    )
    mesh = gltf.load(tmp_path)
    (made,) = mesh.materials
    assert (made.emissive, made.alpha_cutoff) == ((1, 0, 0.5), 1)
    assert (made.base_color, made.metallic, made.roughness) == ((1, 1, 1, 1), 0, 0.5)
    pbr = "a.glb: materials[0].pbrMetallicRoughness: expected"
    assert set(mesh.warnings) == {
        "a.glb: materials[0]: expected emissiveFactor from 0 to 1, found 3, 0, 0.5: cut to it",
        "a.glb: materials[0]: expected alphaCutoff from 0 to 1, found 2: cut to it",
        f"{pbr} baseColorFactor from 0 to 1, found 1, 1, 1.5, 1: cut to it",
        f"{pbr} metallicFactor from 0 to 1, found -1: cut to it",
    }


def test_a_malformed_sampler_repeats(tmp_path: Path) -> None:
    gltf = textured()
    gltf.json.update(samplers=[{"wrapS": 1}])
    gltf.json["textures"][0].update(sampler=0)
    mesh = gltf.load(tmp_path)
    assert "samplers[0]: expected wraps of" in mesh.warnings[0]
    assert mesh.materials[0].maps["base_color"].wrap == ("repeat", "repeat")


def test_a_material_that_is_not_there_is_the_default_one(tmp_path: Path) -> None:
    gltf = textured()
    gltf.json["meshes"][0]["primitives"][0]["material"] = 7
    mesh = gltf.load(tmp_path)
    assert mesh.materials == (Material(metallic=1.0),)
    assert "materials: expected an index below" in mesh.warnings[0]


@pytest.mark.parametrize("counted", [False, True])
def test_bytes_after_the_last_chunk_are_left_out(counted: bool) -> None:
    data = one_triangle().glb() + b"appended by someone"
    if counted:
        data = data[:8] + struct.pack("<I", len(data)) + data[12:]
    mesh = read_gltf(data, "a.glb", NOWHERE)
    assert len(mesh.faces) == 1
    assert mesh.warnings == ("a.glb: left out 19 bytes after the last chunk",)


@pytest.mark.parametrize("more", [-4, 4])
def test_a_wrong_length_in_the_header_is_said(more: int) -> None:
    data = one_triangle().glb()
    data = data[:8] + struct.pack("<I", len(data) + more) + data[12:]
    mesh = read_gltf(data, "a.glb", NOWHERE)
    assert len(mesh.faces) == 1
    assert "bytes as in the header" in mesh.warnings[0]


def test_json_may_be_padded_with_nul() -> None:
    data = one_triangle().glb()
    (length,) = struct.unpack_from("<I", data, 12)
    longer = struct.pack("<I", length + 4), struct.pack("<I", len(data) + 4)
    data = (
        data[:8] + longer[1] + longer[0] + data[16 : 20 + length] + bytes(4) + data[20 + length :]
    )
    mesh = read_gltf(data, "a.glb", NOWHERE)
    assert len(mesh.faces) == 1
    assert mesh.warnings == ()


@pytest.mark.parametrize("indexed", [False, True])
def test_corners_that_make_no_triangle_are_left_out(tmp_path: Path, indexed: bool) -> None:
    gltf = one_triangle()
    primitive = gltf.json["meshes"][0]["primitives"][0]
    primitive["attributes"] = {"POSITION": gltf.accessor([[0, 0, 0], [1, 0, 0], [0, 1, 0]] * 2)}
    if indexed:
        primitive["indices"] = gltf.accessor([0, 1, 2, 5], "<u2")
    else:
        primitive.pop("indices", None)
        primitive["attributes"] = {
            "POSITION": gltf.accessor([[0, 0, 0], [1, 0, 0], [0, 1, 0], [9] * 3])
        }
    mesh = gltf.load(tmp_path)
    assert len(mesh.faces) == 1
    assert mesh.warnings[0].endswith("left out 1 corner(s) after the last triangle")


def test_a_streamed_binary_chunk_reaches_to_the_end() -> None:
    data = bytearray(one_triangle().glb())
    (text,) = struct.unpack_from("<I", data, 12)
    struct.pack_into("<I", data, 20 + text, 0)
    assert len(read_gltf(bytes(data), "a.glb", NOWHERE).faces) == 1


@pytest.mark.parametrize(
    ("spoilt", "said"),
    [
        ({"bufferView": 1}, "images[0] (image_0): expected an image that can be decoded"),
        ({"bufferView": 99}, "bufferViews: expected an index below"),
        ({"uri": "data:;base64,a"}, "images[0]: expected base64"),
    ],
)
def test_an_unreadable_image_is_left_out(tmp_path: Path, spoilt: dict[str, Any], said: str) -> None:
    gltf = textured()
    gltf.json["images"][0] = spoilt
    mesh = gltf.load(tmp_path)
    assert mesh.materials[0].maps == {}
    assert mesh.has_uv.all()
    assert said in mesh.warnings[0]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"glTF", "expected a GLB header"),
        (b"glTF\1\0\0\0\x0c\0\0\0", "expected GLB version 2, found 1"),
        (one_triangle().glb()[:-8], "file cut short"),
        (b"glTF\2\0\0\0\x0c\0\0\0", "expected a JSON chunk first"),
        (b"not json", "expected a glTF document in JSON"),
        (b"[" * 100_000, "expected a glTF document in JSON"),
        (b"[]", "expected a JSON object"),
        (b"{}", "expected a member 'asset'"),
        (b'{"asset": 3}', "asset: expected an object, found 3"),
    ],
)
def test_malformed_containers(data: bytes, expected: str) -> None:
    with pytest.raises(MeshError, match=expected):
        read_gltf(data, "a.glb", NOWHERE)


def test_a_missing_buffer_is_named() -> None:
    document = json.loads(one_triangle().text())
    document["buffers"][0]["uri"] = "gone.bin"
    with pytest.raises(MeshError, match=r"buffers\[0\]: expected a binary file, found 'gone.bin'"):
        read_gltf(json.dumps(document).encode(), "a.gltf", NOWHERE)


WHOLE = textured().glb()
VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(-2, 10), st.floats(), st.text(max_size=3),
    st.lists(st.integers(0, 3), max_size=4), st.just({}), st.just(10**30),
)  # fmt: skip


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths to everything in a JSON value."""
    keys = (
        value.keys() if isinstance(value, dict) else range(len(value) if type(value) is list else 0)
    )
    return [path, *(found for key in keys for found in places(value[key], (*path, key)))]


DOCUMENT = json.loads(textured().text())


@given(st.sampled_from(places(DOCUMENT)[1:]), VALUES)
@settings(max_examples=300)
def test_any_value_anywhere_gives_a_mesh_or_a_mesh_error(path: tuple[Any, ...], value: Any) -> None:
    document = json.loads(json.dumps(DOCUMENT))
    owner = document
    for key in path[:-1]:
        owner = owner[key]
    owner[path[-1]] = value
    found = outcome(read_gltf, json.dumps(document).encode(), "a.gltf", NOWHERE)
    assert isinstance(found, TexturedMesh) or str(found).startswith("a.gltf:")


@given(st.binary(max_size=30), st.integers(0, len(WHOLE)), st.integers(0, 30))
def test_any_bytes_give_a_mesh_or_a_mesh_error(noise: bytes, at: int, removed: int) -> None:
    data = WHOLE[:at] + noise + WHOLE[at + removed :]
    for spoilt in (noise, data):
        found = outcome(read_gltf, spoilt, "a.glb", NOWHERE)
        assert isinstance(found, TexturedMesh | MeshError)
