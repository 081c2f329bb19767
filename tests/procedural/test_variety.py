from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from nispcodec.core.errors import MeshError
from nispcodec.geometry.welding import welded
from nispcodec.io.cleanup import clean
from nispcodec.io.load import load_mesh
from nispcodec.procedural.variety import BREAKAGES, SHAPES, Sample, catalogue, damaged
from tests.cli.conftest import done, nisp, refused


@pytest.fixture(scope="module")
def many() -> list[Sample]:
    return list(catalogue(100, 7))


def test_the_same_seed_makes_the_same_assets(many: list[Sample]) -> None:
    few = list(catalogue(10, 7))
    assert [each.way for each in few] == [each.way for each in many[:10]]
    for one, other in zip(few, many, strict=False):
        np.testing.assert_array_equal(one.mesh.positions, other.mesh.positions)
        assert one.mesh.textures == other.mesh.textures
    assert [each.way for each in catalogue(10, 8)] != [each.way for each in few]


def test_they_vary(many: list[Sample]) -> None:
    assert {each.mesh.name for each in many} == set(SHAPES)
    assert {each.suffix for each in many} == {".obj", ".glb", ".ply"}
    assert {len(each.mesh.materials) for each in many} == {1, 2, 3}
    sizes = [len(each.mesh.faces) for each in many]
    assert max(sizes) > 20 * min(sizes)
    names = [each.way.rpartition("/")[2] for each in many]
    assert len(set(names)) < len({each.way for each in many}) == 100


def test_each_kind_of_damage_is_there_once(many: list[Sample]) -> None:
    assert [each.broken for each in many if each.broken] == list(BREAKAGES)
    assert all(each.way.endswith(each.broken) for each in many if each.broken)


@pytest.mark.parametrize("name", ["ring", "vase", "pillow"])
def test_bodies_are_closed_and_face_outwards(many: list[Sample], name: str) -> None:
    mesh = clean(next(each.mesh for each in many if each.mesh.name == name), name)
    faces = welded(mesh).positions
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    there = {(a, b) for a, b in edges.tolist()}
    assert there == {(b, a) for a, b in there}
    a, b, c = np.moveaxis(mesh.corners - mesh.positions.mean(axis=0), 1, 0)
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0


def test_a_catalogue_is_written_and_what_is_broken_cannot_be_read(tmp_path: Path) -> None:
    result = done("sample", "--count", 100, "--seed", 7, "-o", tmp_path)
    assert result.stdout.startswith(f"{tmp_path}: 100 assets, ")
    paths = [path for path in tmp_path.rglob("*") if path.suffix in (".obj", ".glb", ".ply")]
    assert len(paths) == 100
    broken = [path for path in paths if path.stem.endswith(BREAKAGES)]
    assert len(broken) == len(BREAKAGES)
    for path in broken:
        if path.stem.endswith("no-image"):
            load_mesh(path)
            continue
        with pytest.raises(MeshError):
            load_mesh(path)
    refused(nisp("sample", "--count", 1, "--seed", 7, "-o", tmp_path), "--force overwrites")


def test_a_missing_image_is_not_a_matter_of_the_mesh_file() -> None:
    assert damaged(b"data", "no-image") == b"data"
