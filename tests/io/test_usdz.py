"""USDZ, read and judged by USD itself, where it is installed."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest
from PIL import Image

from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.errors import MeshError, NispError
from nispcodec.core.texture import srgb_to_linear
from nispcodec.io.save import losses, write_mesh
from nispcodec.model import NispModel
from tests import tiny

pytest.importorskip("pxr", reason="the extra `usd` is not installed")

SLOTS = ("base_color", "normal", "metallic_roughness", "occlusion", "emissive")
GLOSSY = Material(
    "wood / oak",
    (0.5, 0.75, 1.0, 0.5),
    metallic=0.25,
    roughness=0.75,
    emissive=(1.0, 0.5, 0.0),
    alpha_mode="mask",
    alpha_cutoff=0.3,
    double_sided=True,
    maps={
        "base_color": TextureMap(0, wrap=("clamp", "mirror")),
        "normal": TextureMap(1),
        "metallic_roughness": TextureMap(0),
        "occlusion": TextureMap(0, strength=0.25),
        "emissive": TextureMap(1),
    },
)


@pytest.fixture(scope="module")
def mesh() -> TexturedMesh:
    found = NispModel(tiny.document()).to_mesh(16)
    image = found.textures[0]
    images = (replace(image, name="a b.png"), replace(image, name="a?b.png"))
    return replace(
        found, textures=images, materials=(GLOSSY, replace(GLOSSY, maps={})), name="my 1"
    )


def stage_of(path: Path) -> Any:
    from pxr import Usd

    return Usd.Stage.Open(str(path))


def complaints(path: Path) -> list[str]:
    """What the validators of USD say, those of USDZ, geometry and shading among them."""
    from pxr import UsdValidation

    every = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    names = {each.GetMetadata().name for each in every}
    assert {
        "usdUtilsValidators:UsdzPackageValidator",
        "usdShadeValidators:NormalMapTextureValidator",
        "usdGeomValidators:StageMetadataChecker",
    } <= names
    context = UsdValidation.ValidationContext(every)
    return [each.GetMessage() for each in context.Validate(stage_of(path))]


def inputs(stage: Any, path: str) -> dict[str, Any]:
    """A shader's inputs: their values, or the shader and the output that they are connected to."""
    from pxr import UsdShade

    shader = UsdShade.Shader.Get(stage, path)
    found = {}
    for each in shader.GetInputs():
        sources, _ = each.GetConnectedSources()
        if sources:
            found[each.GetBaseName()] = (
                sources[0].source.GetPrim().GetName(),
                sources[0].sourceName,
            )
        else:
            found[each.GetBaseName()] = each.Get()
    return found


def test_usd_has_nothing_to_complain_about(mesh: TexturedMesh, tmp_path: Path) -> None:
    assert complaints(write_mesh(mesh, tmp_path / "out.usdz")[0]) == []
    bare = replace(mesh, uv_faces=mesh.uv_faces * 0 - 1)
    assert complaints(write_mesh(bare, tmp_path / "bare.usdz")[0]) == []
    colors = np.full((len(mesh.positions), 4), 0.5, np.float32)
    assert complaints(write_mesh(mesh, tmp_path / "colored.usdz", colors)[0]) == []


def test_usd_would_notice(mesh: TexturedMesh, tmp_path: Path) -> None:
    stage = stage_of(write_mesh(mesh, tmp_path / "out.usdz")[0])
    stage.Export(str(tmp_path / "bad.usda"))
    text = (tmp_path / "bad.usda").read_text()
    (tmp_path / "bad.usda").write_text(text.replace("defaultPrim", "endFrame = 1 #"))
    assert complaints(tmp_path / "bad.usda")


def test_triangles_uvs_and_normals_are_the_meshs(mesh: TexturedMesh, tmp_path: Path) -> None:
    from pxr import UsdGeom

    stage = stage_of(write_mesh(mesh, tmp_path / "out.usdz")[0])
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert stage.GetDefaultPrim().GetPath() == "/my_1"
    corners, uvs = [], []
    for prim in stage.Traverse():
        if not prim.IsA(UsdGeom.Mesh):
            continue
        found = UsdGeom.Mesh(prim)
        assert found.GetSubdivisionSchemeAttr().Get() == "none"
        assert found.GetDoubleSidedAttr().Get()
        faces = np.array(found.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
        points = np.array(found.GetPointsAttr().Get())
        normals = np.array(found.GetNormalsAttr().Get())
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
        a, b, c = points[faces].transpose(1, 0, 2)
        outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), normals[faces].sum(axis=1))
        assert (outwards > 0).mean() > 0.99
        corners.append(points[faces])
        st = UsdGeom.PrimvarsAPI(prim).GetPrimvar("st").Get()
        uvs.append(np.array(st)[faces])
    every = np.concatenate(corners).mean(axis=1), np.concatenate(uvs).mean(axis=1)
    wanted = mesh.corners.mean(axis=1), mesh.corner_uvs.mean(axis=1)
    for one, other in zip(every, wanted, strict=True):
        np.testing.assert_allclose(np.sort(one, axis=0), np.sort(other, axis=0), atol=1e-5)


def test_every_map_is_where_the_surface_takes_it(mesh: TexturedMesh, tmp_path: Path) -> None:
    path = write_mesh(mesh, tmp_path / "out.usdz")[0]
    stage, at = stage_of(path), "/my_1/materials/wood___oak"
    assert inputs(stage, f"{at}/surface") == {
        "diffuseColor": ("base_color", "rgb"),
        "opacity": ("base_color", "a"),
        "opacityThreshold": pytest.approx(0.3),
        "normal": ("normal", "rgb"),
        "roughness": ("metallic_roughness", "g"),
        "metallic": ("metallic_roughness", "b"),
        "occlusion": ("occlusion", "r"),
        "emissiveColor": ("emissive", "rgb"),
    }
    maps = {slot: inputs(stage, f"{at}/{slot}") for slot in SLOTS}
    spaces = {slot: found["sourceColorSpace"] for slot, found in maps.items()}
    assert spaces == {
        "base_color": "sRGB",
        "normal": "raw",
        "metallic_roughness": "raw",
        "occlusion": "raw",
        "emissive": "sRGB",
    }
    assert (maps["base_color"]["wrapS"], maps["base_color"]["wrapT"]) == ("clamp", "mirror")
    assert tuple(maps["base_color"]["scale"]) == GLOSSY.base_color
    assert tuple(maps["normal"]["scale"]) == (2, 2, 2, 1)
    assert tuple(maps["normal"]["bias"]) == (-1, -1, -1, 0)
    assert tuple(maps["metallic_roughness"]["scale"])[1:3] == (0.75, 0.25)
    assert tuple(maps["emissive"]["scale"])[:3] == GLOSSY.emissive
    # Dark by a quarter of what the image says: 1 + 0.25 (red - 1).
    assert (maps["occlusion"]["scale"][0], maps["occlusion"]["bias"][0]) == (0.25, 0.75)
    with ZipFile(path) as package:
        for slot in SLOTS:
            name = maps[slot]["file"].path.removeprefix("./")
            assert package.read(name) == mesh.textures[GLOSSY.maps[slot].texture].data
    plain = inputs(stage, f"{at}_2/surface")
    assert (plain["metallic"], plain["roughness"], plain["opacity"]) == (0.25, 0.75, 0.5)


def test_the_package_is_one_that_phones_read(mesh: TexturedMesh, tmp_path: Path) -> None:
    path = write_mesh(mesh, tmp_path / "out.usdz")[0]
    data = path.read_bytes()
    with ZipFile(path) as package:
        entries = package.infolist()
    assert entries[0].filename.endswith(".usdc")
    assert {each.compress_type for each in entries} == {0}
    for each in entries:
        name, extra = (
            int.from_bytes(data[each.header_offset + at : each.header_offset + at + 2], "little")
            for at in (26, 28)
        )
        assert (each.header_offset + 30 + name + extra) % 64 == 0


def test_colors_are_linear(mesh: TexturedMesh, tmp_path: Path) -> None:
    from pxr import UsdGeom

    colors = np.full((len(mesh.positions), 4), (0.25, 0.5, 0.75, 1), np.float32)
    stage = stage_of(write_mesh(mesh, tmp_path / "out.usdz", colors)[0])
    (prim,) = (each for each in stage.Traverse() if each.IsA(UsdGeom.Mesh))
    shown = np.array(UsdGeom.Mesh(prim).GetDisplayColorPrimvar().Get())
    np.testing.assert_allclose(shown[0], srgb_to_linear(colors[0, :3]), atol=1e-6)
    surface = inputs(stage, "/my_1/materials/vertex_colors/surface")
    assert surface["diffuseColor"] == ("displayColor", "result")


def test_a_mesh_far_away_keeps_its_shape(mesh: TexturedMesh, tmp_path: Path) -> None:
    from pxr import UsdGeom

    far = replace(mesh, positions=mesh.positions + np.array([1e7, 0, 0]))
    stage = stage_of(write_mesh(far, tmp_path / "out.usdz")[0])
    cache = UsdGeom.BBoxCache(0, ["default"])
    box = cache.ComputeWorldBound(stage.GetDefaultPrim()).ComputeAlignedRange()
    np.testing.assert_allclose(box.GetMin(), far.positions.min(axis=0), atol=1e-5)
    np.testing.assert_allclose(box.GetMax(), far.positions.max(axis=0), atol=1e-5)


def test_images_that_phones_do_not_read_become_png(mesh: TexturedMesh, tmp_path: Path) -> None:
    data = BytesIO()
    Image.new("RGB", (4, 4), (200, 0, 0)).save(data, "WEBP")
    webp = tuple(replace(each, data=data.getvalue(), mime="image/webp") for each in mesh.textures)
    path = write_mesh(replace(mesh, textures=webp), tmp_path / "out.usdz")[0]
    with ZipFile(path) as package:
        images = package.namelist()[1:]
        assert sorted(images) == ["a_b.png", "a_b_2.png"]
        assert all(package.read(each).startswith(b"\x89PNG") for each in images)
    (said,) = losses(replace(mesh, textures=webp), "out.usdz")
    assert "converted to PNG" in said


def test_no_room_is_a_sentence(
    mesh: TexturedMesh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "missing"))
    with pytest.raises(NispError, match="cannot be made in a temporary folder"):
        write_mesh(mesh, tmp_path / "out.usdz")


def test_names_that_are_no_text_have_a_place(mesh: TexturedMesh, tmp_path: Path) -> None:
    named = replace(mesh, name="\udcff")
    assert complaints(write_mesh(named, tmp_path / "out.usdz")[0]) == []
    with pytest.raises(MeshError, match=r"expected \.glb or \.gltf"):
        write_mesh(mesh, tmp_path / "out.usdz", compress="quantize")
