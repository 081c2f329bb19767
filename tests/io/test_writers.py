"""Mesh files, read back with other readers than our own where there is one."""

from __future__ import annotations

import json
import re
import struct
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest
import trimesh
from PIL import Image

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError, NispError
from nispcodec.core.texture import linear_to_srgb
from nispcodec.io.load import load_mesh
from nispcodec.io.save import SUFFIXES, losses, mesh_paths, write_mesh
from nispcodec.io.write.glb import glb_bytes
from nispcodec.io.write.images_beside import ImagesBeside
from nispcodec.io.write.obj import obj_files
from tests import tiny

Json = dict[str, Any]
PIXELS = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)
COLORS = np.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1], [0.5, 0.5, 0.5, 1]], np.float32)


@pytest.fixture
def mesh() -> TexturedMesh:
    """A tetrahedron: two textured faces that share a seam, one with a material, one without UV."""
    return TexturedMesh(
        positions=np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        faces=np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.int32),
        uvs=np.array([[0.0, 0.0], [0.5, 0.25], [1.5, -0.5], [0.1, 0.9]]),
        uv_faces=np.array([[0, 1, 2], [3, 2, 1], [0, 1, 2], [-1, -1, -1]], np.int32),
        face_materials=np.array([0, 0, 1, 0], np.int32),
        materials=(
            Material(
                "wood / oak",
                (0.5, 1.0, 1.0, 1.0),
                metallic=0.25,
                alpha_mode="mask",
                alpha_cutoff=0.3,
                maps={
                    "base_color": TextureMap(0, wrap=("clamp", "mirror"), filter="nearest"),
                    "normal": TextureMap(1, strength=0.7),
                },
            ),
            Material("wood_oak", double_sided=True),
        ),
        textures=(tiny.png(PIXELS, "a b.png"), tiny.png(PIXELS[::-1], "a?b.png")),
        name="my mesh",
    )


def glb_parts(data: bytes) -> tuple[Json, bytes]:
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<I4s", data, 12)
    assert kind == b"JSON"
    assert size % 4 == 0
    binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
    assert kind == b"BIN\0"
    assert 28 + size + binary_size == len(data)
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def accessor(tree: Json, binary: bytes, index: int) -> np.ndarray:
    item = tree["accessors"][index]
    view = tree["bufferViews"][item["bufferView"]]
    assert view["byteOffset"] % 4 == 0
    kind = {5126: "<f4", 5125: "<u4"}[item["componentType"]]
    columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[item["type"]]
    data = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    return np.frombuffer(data, kind).reshape(item["count"], columns)


def triangles(positions: np.ndarray, faces: np.ndarray) -> list[list[float]]:
    """Corner positions of each triangle, as a sorted list that does not depend on the order."""
    turned = [
        min(np.roll(face, k, axis=0).ravel().round(5).tolist() for k in range(3))
        for face in positions[faces]
    ]
    return sorted(turned)


def test_glb_holds_the_mesh(mesh: TexturedMesh) -> None:
    tree, binary = glb_parts(glb_bytes(mesh))
    primitives = tree["meshes"][0]["primitives"]
    assert len(primitives) == 3
    found: list[list[float]] = []
    for primitive in primitives:
        positions = accessor(tree, binary, primitive["attributes"]["POSITION"])
        normals = accessor(tree, binary, primitive["attributes"]["NORMAL"])
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
        item = tree["accessors"][primitive["attributes"]["POSITION"]]
        np.testing.assert_array_equal(item["min"], positions.min(axis=0))
        np.testing.assert_array_equal(item["max"], positions.max(axis=0))
        found += triangles(positions, accessor(tree, binary, primitive["indices"]).reshape(-1, 3))
    assert sorted(found) == triangles(mesh.positions, mesh.faces)


def test_glb_flips_v_and_keeps_wild_uvs(mesh: TexturedMesh) -> None:
    tree, binary = glb_parts(glb_bytes(mesh))
    uvs = np.vstack(
        [
            accessor(tree, binary, primitive["attributes"]["TEXCOORD_0"])[
                accessor(tree, binary, primitive["indices"]).ravel()
            ]
            for primitive in tree["meshes"][0]["primitives"]
            if "TEXCOORD_0" in primitive["attributes"]
        ]
    )
    expected = mesh.corner_uvs[mesh.has_uv].reshape(-1, 2) * [1, -1] + [0, 1]
    assert sorted(uvs.astype(float).round(5).tolist()) == sorted(expected.round(5).tolist())


def test_glb_materials(mesh: TexturedMesh) -> None:
    tree, binary = glb_parts(glb_bytes(mesh))
    by_textures = sorted(tree["materials"], key=lambda item: "normalTexture" in item)
    textured = by_textures[-1]
    assert textured["name"] == "wood / oak"
    assert textured["alphaMode"] == "MASK"
    assert textured["alphaCutoff"] == 0.3
    assert textured["normalTexture"]["scale"] == 0.7
    assert textured["pbrMetallicRoughness"]["baseColorFactor"] == [0.5, 1, 1, 1]
    assert textured["pbrMetallicRoughness"]["metallicFactor"] == 0.25
    texture = tree["textures"][textured["pbrMetallicRoughness"]["baseColorTexture"]["index"]]
    sampler = tree["samplers"][texture["sampler"]]
    assert sampler == {"magFilter": 9728, "minFilter": 9984, "wrapS": 33071, "wrapT": 33648}
    view = tree["bufferViews"][tree["images"][texture["source"]]["bufferView"]]
    start = view["byteOffset"]
    assert binary[start : start + view["byteLength"]] == mesh.textures[0].data
    # The face without UV gets the same material without maps; the double-sided one keeps its flag.
    assert [item["doubleSided"] for item in by_textures].count(True) == 1
    assert len(by_textures) == 3


@pytest.mark.parametrize(("kind", "mime"), [("WEBP", "image/webp"), ("AVIF", "image/avif")])
def test_glb_of_modern_images(mesh: TexturedMesh, kind: str, mime: str) -> None:
    data = BytesIO()
    Image.fromarray(np.full((8, 8, 3), 200, np.uint8)).save(data, kind)
    textures = (Texture("x." + kind.lower(), data.getvalue(), mime), mesh.textures[1])
    tree, binary = glb_parts(glb_bytes(replace(mesh, textures=textures)))
    if kind == "WEBP":
        assert tree["extensionsRequired"] == tree["extensionsUsed"] == ["EXT_texture_webp"]
        sources = [
            t["extensions"]["EXT_texture_webp"] for t in tree["textures"] if "source" not in t
        ]
        assert len(sources) == 1
    else:
        assert "extensionsUsed" not in tree
        image = next(item for item in tree["images"] if item["name"] == "x.avif")
        view = tree["bufferViews"][image["bufferView"]]
        assert image["mimeType"] == "image/png"
        start = view["byteOffset"]
        with Image.open(BytesIO(binary[start : start + view["byteLength"]])) as png:
            assert png.format == "PNG"
            assert abs(int(np.asarray(png)[4, 4, 0]) - 200) < 8


def test_images_of_one_name_are_kept_apart(mesh: TexturedMesh) -> None:
    twins = tuple(replace(texture, name="same.png") for texture in mesh.textures)
    tree, _ = glb_parts(glb_bytes(replace(mesh, textures=twins)))
    assert len(tree["images"]) == 2


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj", ".ply", ".stl"])
def test_trimesh_reads_the_same_triangles(mesh: TexturedMesh, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"out{suffix}"
    written = write_mesh(mesh, path)
    assert written[-1] == path
    assert sorted(written) == sorted(tmp_path.iterdir())
    loaded = trimesh.load_mesh(path, process=False)
    assert triangles(loaded.vertices, loaded.faces) == triangles(mesh.positions, mesh.faces)


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj"])
def test_our_own_reader_finds_everything_again(
    mesh: TexturedMesh, tmp_path: Path, suffix: str
) -> None:
    again = load_mesh(write_mesh(mesh, tmp_path / f"out{suffix}")[-1])
    assert triangles(again.positions, again.faces) == triangles(mesh.positions, mesh.faces)
    corner_uvs = [m.corner_uvs[m.has_uv].round(5).reshape(-1, 6).tolist() for m in (again, mesh)]
    assert sorted(corner_uvs[0]) == sorted(corner_uvs[1])
    wood = next(m for m in again.materials if m.maps)
    assert set(wood.maps) == {"base_color", "normal"}
    assert wood.metallic == 0.25
    assert wood.maps["normal"].strength == pytest.approx(0.7)
    data = {slot: again.textures[used.texture].data for slot, used in wood.maps.items()}
    assert data == {"base_color": mesh.textures[0].data, "normal": mesh.textures[1].data}
    if suffix != ".obj":
        assert wood.base_color == mesh.materials[0].base_color
        assert wood.maps["base_color"].wrap == ("clamp", "mirror")
        assert wood.maps["base_color"].filter == "nearest"
        assert (wood.alpha_mode, wood.alpha_cutoff) == ("mask", 0.3)


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".obj", ".ply"])
@pytest.mark.parametrize(("offset", "scale"), [(1e7, 1.0), (0.0, 1e-4), (-3e5, 1e3)])
def test_far_and_tiny_meshes_keep_their_shape(
    mesh: TexturedMesh, tmp_path: Path, suffix: str, offset: float, scale: float
) -> None:
    moved = replace(mesh, positions=mesh.positions * scale + offset)
    again = load_mesh(write_mesh(moved, tmp_path / f"out{suffix}")[-1])
    placed = (again.positions - offset) / scale
    assert triangles(placed, again.faces) == triangles(mesh.positions, mesh.faces)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("colored", [False, True])
def test_the_paths_are_known_before_the_mesh(
    mesh: TexturedMesh, tmp_path: Path, suffix: str, colored: bool
) -> None:
    if suffix == ".usdz":
        pytest.importorskip("pxr", reason="the extra `usd` is not installed")
    path = tmp_path / f"my.mesh{suffix.upper()}"
    colors = np.ones((len(mesh.positions), 4), np.float32) if colored else None
    if colored and suffix == ".stl":
        with pytest.raises(MeshError, match="STL holds no colors"):
            mesh_paths(path, mesh.materials, mesh.textures, colored)
        return
    expected = mesh_paths(path, mesh.materials, mesh.textures, colored)
    assert expected == write_mesh(mesh, path, colors)
    assert expected[-1] == path


@pytest.mark.parametrize("suffix", [".gltf", ".obj", ".ply"])
def test_a_coarser_mesh_shares_images(mesh: TexturedMesh, tmp_path: Path, suffix: str) -> None:
    finer, path = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    write_mesh(mesh, finer)
    before = {each: each.stat().st_mtime_ns for each in tmp_path.iterdir()}
    written = write_mesh(mesh, path, finer=finer)
    assert written == mesh_paths(path, mesh.materials, mesh.textures, finer=finer)
    assert all(each.stem == "b" for each in written)
    assert {each: each.stat().st_mtime_ns for each in before} == before
    assert load_mesh(path).textures == load_mesh(finer).textures


def test_gltf_names_its_files_as_uris(mesh: TexturedMesh, tmp_path: Path) -> None:
    written = write_mesh(mesh, tmp_path / "a: 100 % #1 ?ü.gltf")
    tree = json.loads(written[-1].read_bytes())
    uris = [each["uri"] for each in (*tree["images"], *tree["buffers"])]
    assert all(re.fullmatch(r"[\w.%-]+", each, re.ASCII) for each in uris)
    assert {unquote(each) for each in uris} == {path.name for path in written[:-1]}
    assert [each.data for each in load_mesh(written[-1]).textures] == [
        each.data for each in mesh.textures
    ]


def test_gltf_says_what_a_glb_says(mesh: TexturedMesh, tmp_path: Path) -> None:
    tree = json.loads(write_mesh(mesh, tmp_path / "out.gltf")[-1].read_bytes())
    inside, _ = glb_parts(glb_bytes(mesh))
    same = ("scene", "scenes", "nodes", "materials", "textures", "samplers")
    assert [tree[key] for key in same] == [inside[key] for key in same]
    assert {each["type"] for each in tree["accessors"]} == {"VEC2", "VEC3", "VEC4", "SCALAR"}


@pytest.mark.parametrize(
    ("suffix", "others"),
    [(".gltf", ["o_1.png", "o.bin"]), (".obj", ["o_1.png", "o.mtl"]), (".ply", [])],
)
def test_images_in_files_are_png_for_avif(
    mesh: TexturedMesh, tmp_path: Path, suffix: str, others: list[str]
) -> None:
    data = BytesIO()
    Image.fromarray(PIXELS).save(data, "AVIF")
    avif = tuple(Texture(f"{k}.AVIF", data.getvalue(), "image/avif") for k in range(2))
    written = write_mesh(replace(mesh, textures=avif), tmp_path / f"o{suffix}")
    assert [path.name for path in written] == ["o_0.png", *others, f"o{suffix}"]
    assert Image.open(tmp_path / "o_0.png").format == "PNG"
    assert "o_0.png" in b"".join(path.read_bytes() for path in written[1:]).decode(errors="replace")


@pytest.mark.parametrize("suffix", [".gltf", ".obj"])
def test_png_made_for_avif_takes_no_other_image_of_its_name(
    mesh: TexturedMesh, tmp_path: Path, suffix: str
) -> None:
    data = BytesIO()
    Image.fromarray(np.full((4, 4, 3), 200, np.uint8)).save(data, "AVIF")
    images = (tiny.png(PIXELS, "wood.png"), Texture("wood.avif", data.getvalue(), "image/avif"))
    again = load_mesh(write_mesh(replace(mesh, textures=images), tmp_path / f"o{suffix}")[-1])
    wood = next(each for each in again.materials if each.maps)
    color, normal = (again.textures[each.texture].data for each in wood.maps.values())
    assert color == images[0].data
    assert abs(int(np.asarray(Image.open(BytesIO(normal)))[2, 2, 0]) - 200) < 8


def test_obj_text(mesh: TexturedMesh) -> None:
    files = obj_files(mesh, "out", ImagesBeside.of(mesh, "out"))
    assert set(files) == {"out.obj", "out.mtl", "out_a_b.png", "out_2_a_b.png"}
    assert files["out_a_b.png"] == mesh.textures[0].data
    lines = files["out.obj"].decode().splitlines()
    assert lines[0] == "mtllib out.mtl"
    assert "f 1/1/1 3/2/3 2/3/2" in lines
    assert "f 2//2 3//3 4//4" in lines
    assert lines.count("s 1") == 1
    assert sum(line.startswith("vn ") for line in lines) == 4
    assert "vt 1.5 -0.5" in lines
    used = [line.split()[1] for line in lines if line.startswith("usemtl")]
    mtl = files["out.mtl"].decode().splitlines()
    defined = [line.split()[1] for line in mtl if line.startswith("newmtl")]
    assert used == defined
    assert len(set(defined)) == 2
    assert "map_Kd out_a_b.png" in mtl
    assert "norm -bm 0.7 out_2_a_b.png" in mtl
    assert "map_Bump -bm 0.7 out_2_a_b.png" in mtl


def test_ply_doubles_seams_only(mesh: TexturedMesh, tmp_path: Path) -> None:
    write_mesh(mesh, tmp_path / "out.ply")
    header = (tmp_path / "out.ply").read_bytes().split(b"end_header\n")[0].decode()
    corners = {(p, t) for p, t in zip(mesh.faces.flat, mesh.uv_faces.flat, strict=True)}
    assert f"element vertex {len(corners)}\n" in header


def test_ply_names_its_images(mesh: TexturedMesh, tmp_path: Path) -> None:
    written = write_mesh(mesh, tmp_path / "out.ply")
    assert [path.name for path in written] == ["out_a_b.png", "out.ply"]
    again = load_mesh(written[-1])
    assert again.warnings == ()
    assert [texture.data for texture in again.textures] == [mesh.textures[0].data]
    shown = [bool(again.materials[number].maps) for number in again.face_materials]
    assert shown == [True, True, False, False]


def lost(mesh: TexturedMesh, suffix: str, *maps: TextureMap, **material: Any) -> str:
    slots = ("base_color", "occlusion")
    made = Material(maps=dict(zip(slots, maps, strict=False)), **material)
    return " | ".join(losses(replace(mesh, materials=(made, Material())), f"x{suffix}"))


PLAIN = TextureMap(0)


@pytest.mark.parametrize(
    ("suffix", "maps", "material", "said"),
    [
        (".obj", (PLAIN, PLAIN), {}, "x.obj: left out maps: occlusion"),
        (".ply", (PLAIN, PLAIN), {}, "x.ply: left out maps: occlusion"),
        (".obj", (PLAIN,), {"alpha_mode": "mask"}, "x.obj: left out alpha modes: MTL has none"),
        (".ply", (PLAIN,), {"alpha_mode": "blend"}, "x.ply: left out alpha modes: PLY has none"),
        (".obj", (TextureMap(0, ("mirror", "repeat")),), {}, "x.obj: left out wraps"),
        (".ply", (TextureMap(0, ("clamp", "clamp")),), {}, "x.ply: left out wraps"),
        (".obj", (TextureMap(0, filter="nearest"),), {}, "x.obj: left out the filter nearest"),
        (".ply", (), {"metallic": 1.0}, "x.ply: left out factors of materials"),
        (".stl", (), {}, "x.stl: left out texture coordinates, materials and images"),
    ],
)
def test_what_a_format_cannot_hold_is_said(
    mesh: TexturedMesh, suffix: str, maps: tuple[TextureMap, ...], material: Any, said: str
) -> None:
    assert lost(mesh, suffix, *maps, **material).startswith(said)
    assert lost(mesh, ".glb", *maps, **material) == ""


def test_stl_says_what_it_rounds_far_from_the_origin(mesh: TexturedMesh) -> None:
    plain = TexturedMesh.geometry_only(mesh.positions, mesh.faces, "x")
    assert losses(plain, "x.stl") == ()
    far = replace(plain, positions=plain.positions + np.array([500_000.25, 5_000_000.3, 100.1]))
    (said,) = losses(far, "x.stl")
    assert said == (
        "x.stl: left out digits of positions: STL rounds them by up to 0.2, where the extent is 1: "
        "move the asset to the origin, or write GLB, OBJ or PLY, which keep them"
    )
    assert losses(far, "x.ply") == losses(far, "x.obj") == losses(far, "x.glb") == ()


def test_what_a_format_holds_is_no_loss(mesh: TexturedMesh) -> None:
    assert lost(mesh, ".obj", TextureMap(0, ("clamp", "clamp")), metallic=0.5) == ""
    assert lost(mesh, ".obj", PLAIN, base_color=(1, 1, 1, 0.5), alpha_mode="blend") == ""
    assert lost(mesh, ".ply", PLAIN) == ""
    assert lost(mesh, ".glb", PLAIN, PLAIN) == ""


def test_images_that_glb_converts_are_said(mesh: TexturedMesh) -> None:
    avif = tuple(replace(each, mime="image/avif") for each in mesh.textures)
    assert "converted to PNG" in losses(replace(mesh, textures=avif), "x.glb")[0]


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".glb", ".gltf"])
def test_names_that_are_no_text_are_kept_as_bytes(
    mesh: TexturedMesh, tmp_path: Path, suffix: str
) -> None:
    named = replace(mesh, name="\udcff")
    again = load_mesh(write_mesh(named, tmp_path / f"K\udcf6rper{suffix}")[-1])
    assert len(again.faces) == 4


def test_names_that_no_line_or_file_system_holds_are_refused(
    mesh: TexturedMesh, tmp_path: Path
) -> None:
    for name in ("a\nusemtl b.obj", "a\0b/c.glb"):
        with pytest.raises(MeshError, match="without control characters"):
            write_mesh(mesh, tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".obj", ".ply"])
def test_vertex_colors(mesh: TexturedMesh, tmp_path: Path, suffix: str) -> None:
    path = write_mesh(mesh, tmp_path / f"out{suffix}", COLORS)[-1]
    loaded = trimesh.load_mesh(path, process=False)
    assert isinstance(loaded.visual, trimesh.visual.ColorVisuals)
    found = np.asarray(loaded.visual.vertex_colors)[:, :3] / 255
    assert len(loaded.vertices) == 4
    nearest = np.linalg.norm(loaded.vertices[:, None] - mesh.positions, axis=2).argmin(axis=1)
    np.testing.assert_allclose(found, COLORS[nearest, :3], atol=0.01)


def test_glb_colors_are_linear(mesh: TexturedMesh, tmp_path: Path) -> None:
    tree, binary = glb_parts(write_mesh(mesh, tmp_path / "out.glb", COLORS)[-1].read_bytes())
    (primitive,) = tree["meshes"][0]["primitives"]
    found = accessor(tree, binary, primitive["attributes"]["COLOR_0"])
    np.testing.assert_allclose(linear_to_srgb(found[:, :3]), COLORS[:, :3], atol=1e-4)
    assert "images" not in tree


def test_colors_that_do_not_fit_are_refused(mesh: TexturedMesh, tmp_path: Path) -> None:
    with pytest.raises(MeshError, match=r"expected shape \(4, 4\)"):
        write_mesh(mesh, tmp_path / "out.glb", np.ones((3, 4), np.float32))
    with pytest.raises(MeshError, match="STL holds no colors"):
        write_mesh(mesh, tmp_path / "out.stl", np.ones((4, 4), np.float32))
    assert not list(tmp_path.iterdir())


def test_unknown_suffix_names_the_choices(mesh: TexturedMesh, tmp_path: Path) -> None:
    with pytest.raises(
        MeshError, match=r"\.glb, \.gltf, \.ply, \.stl, \.obj, \.usdz, found '\.fbx'"
    ):
        write_mesh(mesh, tmp_path / "out.fbx")
    assert not list(tmp_path.iterdir())


def test_failed_writing_leaves_nothing(mesh: TexturedMesh, tmp_path: Path) -> None:
    (tmp_path / "out.glb").mkdir()
    with pytest.raises(NispError, match=r"out\.glb"):
        write_mesh(mesh, tmp_path / "out.glb")
    assert [path.name for path in tmp_path.iterdir()] == ["out.glb"]


def test_a_mesh_without_faces_is_refused(mesh: TexturedMesh, tmp_path: Path) -> None:
    nothing = replace(
        mesh,
        faces=np.zeros((0, 3), np.int32),
        uv_faces=np.zeros((0, 3), np.int32),
        face_materials=np.zeros(0, np.int32),
    )
    for suffix in SUFFIXES:
        with pytest.raises(MeshError, match="found none"):
            write_mesh(nothing, tmp_path / f"out{suffix}")
    assert not list(tmp_path.iterdir())
