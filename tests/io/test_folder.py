from __future__ import annotations

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


def test_an_absolute_path_that_is_here(folder: Folder) -> None:
    other = (folder.path.parent / "other.png").resolve()
    assert folder.find(str(other)) == other
