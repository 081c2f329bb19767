from __future__ import annotations

import os
from pathlib import Path

import pytest

from nispcodec.io.folder import Folder


@pytest.fixture
def folder(tmp_path: Path) -> Folder:
    (tmp_path / "asset" / "Maps").mkdir(parents=True)
    for name in ("asset/wood.png", "asset/Maps/Stone.JPG", "other.png"):
        (tmp_path / name).write_text(name)
    return Folder(tmp_path / "asset")


def found_text(folder: Folder, reference: str) -> str:
    path = folder.find(reference)
    assert path is not None
    return path.read_text()


@pytest.mark.parametrize(
    ("reference", "found"),
    [
        ("wood.png", "asset/wood.png"),
        ("WOOD.png", "asset/wood.png"),
        ("./wood.png", "asset/wood.png"),
        ("maps/stone.jpg", "asset/Maps/Stone.JPG"),
        ("Maps\\Stone.JPG", "asset/Maps/Stone.JPG"),
        ("..\\other.png", "other.png"),
        ("D:\\work\\maps\\wood.png", "asset/wood.png"),
        ("/somewhere/else/wood.png", "asset/wood.png"),
        ("C:\\Users\\me\\maps\\stone.jpg", "asset/Maps/Stone.JPG"),
        ("/maps/stone.jpg", "asset/Maps/Stone.JPG"),
        ("a/../wood.png/..\\wood.png", "asset/wood.png"),
    ],
)
def test_finds(folder: Folder, reference: str, found: str) -> None:
    assert found_text(folder, reference) == found


@pytest.mark.parametrize(
    "reference", ["", ".", "..", "Maps", "gone.png", "wood.png/x", "nul\0", "x" * 5000, "stone.jpg"]
)
def test_finds_nothing(folder: Folder, reference: str) -> None:
    assert folder.find(reference) is None


def test_an_exact_name_goes_before_another_case(folder: Folder) -> None:
    (folder.path / "WOOD.png").write_text("upper")
    assert found_text(folder, "WOOD.png") == "upper"
    assert found_text(folder, "wood.png") == "asset/wood.png"


def test_of_the_ends_of_a_path_the_longest_is_taken(folder: Folder) -> None:
    (folder.path / "stone.jpg").write_text("another")
    assert found_text(folder, "D:\\work\\maps\\stone.jpg") == "asset/Maps/Stone.JPG"
    assert found_text(folder, "D:\\work\\stone.jpg") == "another"


def test_the_whole_path_alone_is_exact(folder: Folder) -> None:
    assert folder.exact("gone/wood.png") is None
    assert folder.exact("Maps/Stone.JPG") == folder.path / "Maps" / "Stone.JPG"


def test_a_path_of_many_names_takes_no_time(folder: Folder) -> None:
    assert folder.find("a/" * 200_000 + "wood.png") == folder.path / "wood.png"


def test_a_name_whose_bytes_are_latin_1(folder: Folder) -> None:
    stored = os.fsdecode(os.fsencode(folder.path) + b"/K\xf6rper.png")
    try:
        Path(stored).write_text("bytes")
    except OSError:
        pytest.skip("this file system takes UTF-8 alone")
    assert found_text(folder, "K\u00f6rper.png") == "bytes"
    assert found_text(folder, "k\u00d6rper.PNG") == "bytes"


def test_an_absolute_path_that_is_here(folder: Folder) -> None:
    other = (folder.path.parent / "other.png").resolve()
    assert folder.find(str(other)) == other
