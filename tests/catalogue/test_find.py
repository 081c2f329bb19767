from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from nispcodec.catalogue.find import Patterns, find_assets
from nispcodec.catalogue.plan import Asset, Problem
from tests.catalogue.stubs import TRIANGLES, meshes


def outputs(*inputs: object, patterns: Patterns = Patterns()) -> list[str]:
    found = find_assets([str(each) for each in inputs], patterns)
    return [each.output for each in found if isinstance(each, Asset)]


def problems(*inputs: object) -> list[str]:
    found = find_assets([str(each) for each in inputs])
    return [f"{each.source}: {each.error}" for each in found if isinstance(each, Problem)]


def test_folders_keep_their_paths_and_other_files_are_none(tmp_path: Path) -> None:
    meshes(tmp_path, "b", "a", "deep/down/a")
    (tmp_path / "notes.txt").write_text("no mesh")
    assert outputs(tmp_path) == ["a.nisp", "b.nisp", "deep/down/a.nisp"]
    assert outputs(tmp_path / "b.obj") == ["b.nisp"]


@pytest.mark.parametrize(
    ("patterns", "expected"),
    [
        (Patterns(include=("a*",)), ["a.nisp", "deep/a.nisp"]),
        (Patterns(exclude=("deep/*",)), ["a.nisp", "b.nisp"]),
        (Patterns(("*.obj",), ("a.obj",)), ["b.nisp"]),
    ],
)
def test_patterns_are_of_names_and_of_paths(
    tmp_path: Path, patterns: Patterns, expected: list[str]
) -> None:
    meshes(tmp_path, "a", "b", "deep/a")
    assert outputs(tmp_path, patterns=patterns) == expected


def test_a_glob_keeps_what_follows_its_fixed_part(tmp_path: Path) -> None:
    meshes(tmp_path, "one/x/a", "one/y/a", "two/z/a")
    assert outputs(f"{tmp_path}/one/*/a.obj") == ["x/a.nisp", "y/a.nisp"]
    assert outputs(f"{tmp_path}/**/a.obj") == ["one/x/a.nisp", "one/y/a.nisp", "two/z/a.nisp"]


def test_a_list_has_a_path_a_line(tmp_path: Path) -> None:
    meshes(tmp_path, "a", "b")
    listed = [f"{tmp_path}/b.obj\r\n", "\n", f"{tmp_path}/a.obj\n", "-\n"]
    assert [each.source for each in find_assets(["-"], listed=listed)] == [
        f"{tmp_path}/b.obj",
        f"{tmp_path}/a.obj",
    ]


def test_each_input_that_is_none_is_a_problem(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "notes.txt").touch()
    (said,) = problems(tmp_path / "empty")
    assert "empty: expected mesh files (.obj" in said
    assert "found none" in said
    assert "expected a file, found none" in problems(tmp_path / "gone.obj")[0]
    assert "expected a mesh file, a folder" in problems(tmp_path / "gone")[0]
    assert "found '.txt'" in problems(tmp_path / "notes.txt")[0]
    assert "found none" in problems(f"{tmp_path}/*.glb")[0]
    assert "without NUL" in problems("a\0b")[0]


def test_a_link_to_a_folder_that_it_is_in_is_a_problem(tmp_path: Path) -> None:
    meshes(tmp_path, "a/mesh")
    (tmp_path / "a" / "loop").symlink_to(tmp_path)
    (tmp_path / "beside").symlink_to(tmp_path / "a")
    (tmp_path / "lost.obj").symlink_to(tmp_path / "nowhere.obj")
    assert outputs(tmp_path) == ["a/mesh.nisp", "beside/mesh.nisp"]
    said = problems(tmp_path)
    assert sum("a link to one that it is in" in each for each in said) == 2
    assert sum("lost.obj: expected a file that can be read" in each for each in said) == 1


@pytest.mark.skipif(sys.platform == "darwin", reason="its file systems have names in UTF-8 alone")
def test_names_need_not_be_utf8(tmp_path: Path) -> None:
    path = os.fsencode(tmp_path) + b"/caf\xe9.obj"
    Path(os.fsdecode(path)).write_text(TRIANGLES)
    assert outputs(tmp_path) == [os.fsdecode(b"caf\xe9.nisp")]


def test_a_folder_that_cannot_be_read_is_a_problem(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    meshes(tmp_path, "a", "shut/b")
    scan = os.scandir

    def refusing(place: str) -> object:
        if str(place).endswith("shut"):
            raise PermissionError(13, "Permission denied", place)
        return scan(place)

    monkeypatch.setattr(os, "scandir", refusing)
    assert outputs(tmp_path) == ["a.nisp"]
    assert "shut: expected a folder to read, found: Permission denied" in problems(tmp_path)[0]
