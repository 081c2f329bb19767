"""trimesh reads our files once it is told, and gets what the decoder gives, seams and looks too."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import trimesh
from trimesh.exchange import load as trimesh_load
from trimesh.visual import TextureVisuals

import nispcodec
from nispcodec.core.arrays import AnyArray
from nispcodec.core.asset import Material, TexturedMesh, TextureMap
from nispcodec.core.texture import image_bytes
from nispcodec.format import pack
from nispcodec.model import NispModel
from tests import tiny

CONFORMANCE = Path(__file__).parent / "conformance"
CELLS = 24


@pytest.fixture(autouse=True)
def table() -> Iterator[None]:
    """Others see trimesh's table as it was."""
    before = dict(trimesh_load.mesh_loaders)
    yield
    trimesh_load.mesh_loaders.clear()
    trimesh_load.mesh_loaders.update(before)


def corners(mesh: trimesh.Trimesh) -> AnyArray:
    """(m, 15) of every face's positions and UVs, faces and their corners in one order."""
    assert isinstance(mesh.visual, TextureVisuals)
    uv = mesh.visual.uv
    uv = np.zeros((len(mesh.vertices), 2)) if uv is None else uv
    rows = np.column_stack([mesh.vertices, uv])[mesh.faces]
    return in_order(rows)


def expected_corners(mesh: TexturedMesh, faces: AnyArray) -> AnyArray:
    rows = np.concatenate([mesh.corners, mesh.corner_uvs.astype(np.float32)], axis=2)[faces]
    return in_order(rows)


def in_order(rows: AnyArray) -> AnyArray:
    flat = rows.reshape(len(rows), -1)
    return flat[np.lexsort(flat.T)]


def models() -> list[NispModel]:
    """A field, meshes, and both."""
    names = ["mesh-copies", "mesh-uv-partly"]
    documents = [nispcodec.load(CONFORMANCE / f"{name}.nisp").document for name in names]
    both = replace(documents[1], field=tiny.document().field)
    return [NispModel(each) for each in (tiny.document(), *documents, both)]


@pytest.mark.parametrize("model", models(), ids=["field", "copies", "partly", "both"])
def test_a_scene_has_the_faces_of_the_decoder_with_their_uvs(model: NispModel) -> None:
    mesh = model.to_mesh(CELLS)
    scene = model.to_trimesh(CELLS)
    keys = mesh.face_materials * 2 + mesh.has_uv
    assert len(scene.geometry) == len(np.unique(keys))
    for key, part in zip(np.unique(keys), scene.geometry.values(), strict=True):
        assert np.array_equal(corners(part), expected_corners(mesh, keys == key))
        assert (np.einsum("ij,ij->i", part.vertex_normals, part.vertex_normals) > 0.99).all()


def test_the_material_is_that_of_gltf() -> None:
    images = tuple(tiny.png(np.full((2, 3, 3), 40 * each, np.uint8)) for each in range(5))
    slots = ("base_color", "normal", "metallic_roughness", "occlusion", "emissive")
    maps = {slot: TextureMap(number) for number, slot in enumerate(slots)}
    material = Material(
        "wood", (1.0, 0.0, 0.2, 0.4), 0.25, 0.75, (0.1, 0.2, 0.3), "mask", 0.3, True, maps
    )
    document = replace(tiny.document(), materials=(material,) * 2, textures=images)
    scene = NispModel(document).to_trimesh(CELLS)
    assert list(scene.geometry) == ["wood", "wood-2"]
    made = scene.geometry["wood"].visual.material
    found = [
        made.baseColorTexture,
        made.normalTexture,
        made.metallicRoughnessTexture,
        made.occlusionTexture,
        made.emissiveTexture,
    ]
    for image, texture in zip(found, images, strict=True):
        assert np.array_equal(np.asarray(image), image_bytes(texture)[..., :3])
    assert (made.name, made.alphaMode, made.alphaCutoff, made.doubleSided) == (
        "wood",
        "MASK",
        0.3,
        True,
    )
    assert made.baseColorFactor.tolist() == [255, 0, 51, 102]
    assert (made.metallicFactor, made.roughnessFactor) == (0.25, 0.75)
    assert made.emissiveFactor.tolist() == [0.1, 0.2, 0.3]


def test_trimesh_loads_a_file_by_its_path_and_from_an_open_file(tmp_path: Path) -> None:
    path = tmp_path / "model.NISP"
    path.write_bytes(pack(tiny.document()))
    nispcodec.register_trimesh()
    expected = NispModel(tiny.document()).to_trimesh(CELLS)
    scene = trimesh.load(path, resolution=CELLS)
    stream = BytesIO(path.read_bytes())
    again = trimesh.load_scene(stream, file_type="nisp", resolution=CELLS, metadata={"a": 1})
    for found in (scene, again):
        assert isinstance(found, trimesh.Scene)
        assert list(found.geometry) == list(expected.geometry) == ["painted", "plain"]
        for name, part in found.geometry.items():
            assert np.array_equal(corners(part), corners(expected.geometry[name]))
    assert again.metadata["a"] == 1


def test_trimesh_loads_one_mesh_with_fewer_faces(tmp_path: Path) -> None:
    path = tmp_path / "model.nisp"
    path.write_bytes(pack(tiny.document()))
    nispcodec.register_trimesh()
    mesh = trimesh.load_mesh(path, resolution=CELLS, faces=200)
    assert 0 < len(mesh.faces) <= 200
    assert isinstance(mesh.visual, TextureVisuals)
    assert mesh.visual.uv is not None


def test_what_trimesh_has_no_place_for_is_warned_of() -> None:
    used = TextureMap(0, wrap=("clamp", "repeat"), filter="nearest", strength=0.5)
    material = Material("odd", maps={"normal": used})
    document = replace(tiny.document(), materials=(material,) * 2)
    with pytest.warns(nispcodec.NispWarning) as said:
        NispModel(document).to_trimesh(CELLS)
    text = "\n".join(str(each.message) for each in said)
    for word in ("strengths of maps", "wraps", "the filter nearest"):
        assert f"left out {word}" in text


def test_a_broken_file_is_our_error(tmp_path: Path) -> None:
    (tmp_path / "broken.nisp").write_bytes(pack(tiny.document())[:-1])
    nispcodec.register_trimesh()
    with pytest.raises(nispcodec.FormatError, match=r"broken\.nisp: "):
        trimesh.load(tmp_path / "broken.nisp")


def test_without_trimesh_it_is_said_what_to_install() -> None:
    code = (
        "import sys\n"
        "import importlib.util as u; find = u.find_spec\n"
        "u.find_spec = lambda name: None if name == 'trimesh' else find(name)\n"
        "import nispcodec\n"
        "try: nispcodec.register_trimesh()\n"
        "except nispcodec.NispError as why: print(why)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'nispcodec[trimesh]'" in run.stdout
