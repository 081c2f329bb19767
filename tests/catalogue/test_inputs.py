from __future__ import annotations

import base64
import json
from pathlib import Path

import pytest

from nispcodec.catalogue.inputs import InputBytes, content, read_noted, unchanged
from nispcodec.core.errors import MeshError
from nispcodec.io.load import load_mesh
from nispcodec.io.save import write_mesh
from nispcodec.procedural.mug import sample_asset
from tests.io.files import image


@pytest.fixture
def mug(tmp_path: Path) -> Path:
    path = tmp_path / "mug.obj"
    write_mesh(sample_asset(), path)
    return path


def test_everything_that_an_asset_is_read_from_is_noted(mug: Path) -> None:
    mesh, inputs, _ = read_noted(str(mug))
    assert set(inputs) == {each.name for each in mug.parent.iterdir()}
    assert mesh.warnings == load_mesh(mug).warnings
    assert mesh.name == "mug"
    assert unchanged(str(mug), inputs)


@pytest.mark.parametrize("name", ["mug.obj", "mug.mtl", "mug_mug_color.png"])
def test_a_change_anywhere_is_seen(mug: Path, name: str) -> None:
    _, inputs, _ = read_noted(str(mug))
    path = mug.with_name(name)
    path.write_bytes(path.read_bytes() + b"\n")
    assert not unchanged(str(mug), inputs)
    path.unlink()
    assert not unchanged(str(mug), inputs)


def test_an_image_that_comes_later_is_a_change(mug: Path) -> None:
    image = mug.with_name("mug_mug_color.png")
    data = image.read_bytes()
    image.unlink()
    mesh, inputs, _ = read_noted(str(mug))
    assert inputs["mug_mug_color.png"] is None
    assert mesh.warnings
    assert unchanged(str(mug), inputs)
    image.write_bytes(data)
    assert not unchanged(str(mug), inputs)


@pytest.mark.parametrize("place", ["maps/a.png", "a.png"])
def test_an_image_that_comes_nearer_to_its_path_is_a_change(tmp_path: Path, place: str) -> None:
    obj = tmp_path / "a.obj"
    obj.write_text("mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "a.mtl").write_text("newmtl m\nmap_Kd C:\\work\\maps\\a.png\n")
    if place != "a.png":
        (tmp_path / "a.png").write_bytes(image())
    _, inputs, _ = read_noted(str(obj))
    assert unchanged(str(obj), inputs)
    (tmp_path / place).parent.mkdir(exist_ok=True)
    (tmp_path / place).write_bytes(image(color=(0, 9, 0)))
    assert not unchanged(str(obj), inputs)


@pytest.mark.parametrize("suffix", [".obj", ".gltf", ".glb"])
def test_every_byte_on_the_disk_counts_once(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"mug{suffix}"
    write_mesh(sample_asset(), path)
    images = sum(each.stat().st_size for each in tmp_path.glob("*.png"))
    everything = sum(each.stat().st_size for each in tmp_path.iterdir())
    assert read_noted(str(path))[2] == InputBytes(everything - images, images)


def test_what_is_embedded_does_not_count_again(tmp_path: Path) -> None:
    path = tmp_path / "mug.gltf"
    write_mesh(sample_asset(), path)
    root = json.loads(path.read_text())
    for each in (*root["buffers"], *root["images"]):
        data = base64.b64encode((tmp_path / each["uri"]).read_bytes()).decode()
        each["uri"] = f"data:application/octet-stream;base64,{data}"
    path.write_text(json.dumps(root))
    mesh, _, read = read_noted(str(path))
    assert mesh.textures
    assert read == InputBytes(path.stat().st_size, 0)


def test_content_is_of_all_hashes() -> None:
    some = {"a.obj": "1", "b.png": None}
    assert content(some) == content(dict(reversed(some.items())))
    assert content(some) != content({**some, "b.png": "2"})


def test_unreadable_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match="found none"):
        read_noted(str(tmp_path / "gone.obj"))
    with pytest.raises(MeshError, match="expected one of"):
        read_noted(str(tmp_path / "gone.xyz"))
    (tmp_path / "empty.obj").touch()
    with pytest.raises(MeshError, match="found an empty file"):
        read_noted(str(tmp_path / "empty.obj"))
