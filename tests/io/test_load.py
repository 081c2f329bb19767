from __future__ import annotations

from pathlib import Path

import pytest

from nispcodec.core.errors import MeshError
from nispcodec.io.load import READERS, load_mesh
from tests.io.files import TRIANGLE, image, load_obj


def test_the_name_is_that_of_the_file_and_the_suffix_may_shout(tmp_path: Path) -> None:
    (tmp_path / "my cup.OBJ").write_text(TRIANGLE + "f 1 2 3\n")
    assert load_mesh(tmp_path / "my cup.OBJ").name == "my cup"


def test_the_mesh_is_cleaned(tmp_path: Path) -> None:
    mesh = load_obj(tmp_path, TRIANGLE + "f 1 2 3\nf 1 1 2\nf 2 3 1\n")
    assert len(mesh.faces) == 1
    assert mesh.warnings == ("dropped 1 degenerate face", "dropped 1 duplicate face")


@pytest.mark.parametrize("suffix", READERS)
def test_an_empty_file(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"")
    with pytest.raises(MeshError, match=rf"a\{suffix}: expected a mesh, found an empty file"):
        load_mesh(path)


def test_a_file_without_faces(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match=r"a\.obj: expected at least one face"):
        load_obj(tmp_path, TRIANGLE)


@pytest.mark.parametrize("name", ["a.fbx", "a", "a.nisp"])
def test_an_unknown_extension(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("x")
    with pytest.raises(MeshError, match=r"expected one of \.obj .*\.off"):
        load_mesh(tmp_path / name)


def test_paths_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "folder.obj").mkdir()
    for name in ("gone.obj", "folder.obj", "nul\0.obj"):
        with pytest.raises(MeshError, match="cannot be read"):
            load_mesh(tmp_path / name)


def test_a_corrupt_image_is_a_warning_that_names_it(tmp_path: Path) -> None:
    mtl = "newmtl m\nmap_Kd w.png\n"
    text = "mtllib a.mtl\nusemtl m\n" + TRIANGLE + "f 1 2 3\n"
    mesh = load_obj(tmp_path, text, a_mtl=mtl, w_png=image()[:50])
    (warning,) = mesh.warnings
    assert "w.png: expected an image" in warning
    assert len(mesh.faces) == 1
