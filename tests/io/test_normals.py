"""Creases are where a file's normals jump, in every format that has normals."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import sharp_sides
from nispcodec.io.load import load_mesh
from nispcodec.io.save import write_mesh
from tests.geometry.shapes import cube, soup

# A roof: two faces of two triangles each, whose ridge is from point 2 to point 3.
ROOF = "v 0 0 0\nv 0 2 0\nv 1 0 1\nv 1 2 1\nv 2 0 0\nv 2 2 0\n"
FACES = ((1, 3, 4, 2), (3, 5, 6, 4))
SMOOTH = "vn -1 0 1\nvn 0 0 1\nvn 1 0 1\n"
BY_POINT = {1: 1, 2: 1, 3: 2, 4: 2, 5: 3, 6: 3}


def roof(tmp_path: Path, text: str) -> TexturedMesh:
    (tmp_path / "roof.obj").write_text(ROOF + text, encoding="utf-8")
    return load_mesh(tmp_path / "roof.obj")


def faces(*corners: str) -> str:
    return "".join(f"f {each}\n" for each in corners)


def plain() -> str:
    return faces(*(" ".join(map(str, face)) for face in FACES))


def ridge(mesh: TexturedMesh) -> bool:
    """Whether the ridge is a crease; nothing else is."""
    assert mesh.creases is not None
    assert mesh.creases.sum() in (0, 2)
    starts, ends = mesh.corners, np.roll(mesh.corners, -1, axis=1)
    assert (starts[mesh.creases][:, 2] == 1).all()
    assert (ends[mesh.creases][:, 2] == 1).all()
    return bool(mesh.creases.any())


def test_a_ridge_whose_normals_are_shared_is_smooth(tmp_path: Path) -> None:
    lines = [" ".join(f"{point}//{BY_POINT[point]}" for point in face) for face in FACES]
    assert not ridge(roof(tmp_path, SMOOTH + faces(*lines)))


def test_a_ridge_whose_normals_differ_is_a_crease(tmp_path: Path) -> None:
    lines = [
        " ".join(f"{point}//{normal}" for point in face)
        for face, normal in zip(FACES, (1, 3), strict=True)
    ]
    assert ridge(roof(tmp_path, SMOOTH + faces(*lines)))


@pytest.mark.parametrize(
    ("groups", "crease"), [(("1", "1"), False), (("1", "2"), True), (("off", "off"), True)]
)
def test_without_normals_smoothing_groups_tell(
    tmp_path: Path, groups: tuple[str, str], crease: bool
) -> None:
    first, second = plain().splitlines(keepends=True)
    mesh = roof(tmp_path, f"s {groups[0]}\n{first}s {groups[1]}\n{second}")
    assert ridge(mesh) is crease


def test_without_either_nobody_said(tmp_path: Path) -> None:
    assert roof(tmp_path, plain()).creases is None


@pytest.mark.parametrize("length", ["e30", "e-30", "e200", "e-200", "e-310", "e307"])
def test_normals_may_have_any_length(tmp_path: Path, length: str) -> None:
    normals = re.sub(r"\b1\b", f"1{length}", SMOOTH)
    lines = [" ".join(f"{point}//{BY_POINT[point]}" for point in face) for face in FACES]
    with warnings.catch_warnings(action="error"):
        assert not ridge(roof(tmp_path, normals + faces(*lines)))


def test_normals_that_are_none_make_flat_faces(tmp_path: Path) -> None:
    lines = [" ".join(f"{point}//9" for point in face) for face in FACES]
    mesh = roof(tmp_path, "vn a b c\nvn 0 0 0\n" + faces(*lines, "1//1 3//2 4//1"))
    assert ridge(mesh)
    assert sum("normal" in warning for warning in mesh.warnings) == 2


def box(creases: bool) -> TexturedMesh:
    mesh = soup(cube((0, 0, 0), 1.0))
    places = row_ids(mesh.positions)[mesh.faces]
    sharp = sharp_sides(places, mesh.corners)
    return replace(mesh, creases=sharp if creases else np.zeros_like(sharp))


@pytest.mark.parametrize("suffix", [".glb", ".obj", ".ply"])
@pytest.mark.parametrize("creases", [True, False])
def test_written_normals_come_back(tmp_path: Path, suffix: str, creases: bool) -> None:
    mesh = box(creases)
    write_mesh(mesh, tmp_path / f"box{suffix}")
    back = load_mesh(tmp_path / f"box{suffix}")
    assert back.creases is not None
    assert mesh.creases is not None
    order = [np.lexsort(each.corners.reshape(-1, 9).T) for each in (mesh, back)]
    assert np.array_equal(back.corners[order[1]], mesh.corners[order[0]])
    assert np.array_equal(back.creases[order[1]], mesh.creases[order[0]])


def test_a_gltf_without_normals_is_flat(tmp_path: Path) -> None:
    path = tmp_path / "box.glb"
    write_mesh(box(False), path)
    # Another name of the same length: an attribute that nobody knows.
    path.write_bytes(path.read_bytes().replace(b'"NORMAL"', b'"_FOOBA"'))
    creases = load_mesh(path).creases
    assert creases is not None
    assert creases.sum() == 24
