"""fsspec's `file://` stands for storage elsewhere: other processes see it, too."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("fsspec", reason="URLs: extra `remote`")

from nispcodec.catalogue.find import Patterns, find_assets
from nispcodec.catalogue.inputs import read_noted, unchanged
from nispcodec.catalogue.plan import Asset, Problem
from nispcodec.catalogue.storage import joined, storage_of
from nispcodec.core.errors import MeshError, NispError
from tests.catalogue.stubs import batch, meshes, ran
from tests.io.files import image

MTL = "newmtl red\nmap_Kd Wood.png\n"


def textured(folder: Path) -> Path:
    """An OBJ whose image has a name in other letters, in a folder above."""
    path = meshes(folder, "deep/a") / "deep" / "a.obj"
    path.write_text(
        "mtllib ../m/a.mtl\nvt 0 0\nusemtl red\n"
        + path.read_text().replace("f 1 3 2", "f 1/1 3/1 2/1")
    )
    (folder / "m").mkdir()
    (folder / "m" / "a.mtl").write_text(MTL)
    (folder / "m" / "wood.png").write_bytes(image())
    return path


def test_an_asset_is_read_with_all_that_it_names(tmp_path: Path) -> None:
    path = textured(tmp_path)
    near, near_inputs, _ = read_noted(str(path))
    far, far_inputs, _ = read_noted(path.as_uri())
    assert len(near.textures) == len(far.textures) == 1
    assert far.textures == near.textures
    assert far_inputs == near_inputs
    assert set(far_inputs) >= {"a.obj", "../m/a.mtl", "../m/wood.png"}
    assert unchanged(path.as_uri(), near_inputs)
    (tmp_path / "m" / "wood.png").write_bytes(b"other")
    assert not unchanged(path.as_uri(), near_inputs)


def test_what_is_missing_is_missing(tmp_path: Path) -> None:
    path = textured(tmp_path)
    (tmp_path / "m" / "wood.png").unlink()
    _, inputs, _ = read_noted(path.as_uri())
    assert None in inputs.values()
    with pytest.raises(MeshError, match="expected a file, found none"):
        read_noted((tmp_path / "gone.obj").as_uri())
    folder = storage_of(path.as_uri()).folder(path.as_uri())
    assert folder.find("") is None
    assert folder.find("no/such/folder/x.png") is None
    with pytest.raises(MeshError, match="cannot be read"):
        folder.read(tmp_path / "gone.png")


def test_assets_are_found_in_folders_globs_and_alone(tmp_path: Path) -> None:
    meshes(tmp_path, "a", "deep/b")
    top = tmp_path.as_uri()

    def outputs(*places: str, patterns: Patterns = Patterns()) -> list[str]:
        return [each.output for each in find_assets(places, patterns) if isinstance(each, Asset)]

    assert outputs(top) == ["a.nisp", "deep/b.nisp"]
    assert outputs(top, patterns=Patterns(exclude=("deep/*",))) == ["a.nisp"]
    assert outputs(f"{top}/deep/*.obj") == ["b.nisp"]
    assert outputs(f"{top}/a.obj") == ["a.nisp"]
    (found,) = find_assets([f"{top}/nowhere"])
    assert isinstance(found, Problem)


def test_unknown_kinds_of_urls_are_refused() -> None:
    with pytest.raises(NispError, match="expected a URL that fsspec can open"):
        storage_of("nonsense://a/b")


def test_a_batch_between_urls_is_as_one_on_the_disk(tmp_path: Path) -> None:
    meshes(tmp_path / "in", "a", "deep/b")
    near, far = tmp_path / "near", (tmp_path / "far").as_uri()
    ran([tmp_path / "in"], batch(near))
    run = batch(tmp_path)
    run.folder = far
    first = ran([(tmp_path / "in").as_uri()], run)
    assert [each.record.status for each in first.values()] == ["done", "done"]
    for name in ("a.nisp", "deep/b.nisp"):
        assert storage_of(far).read(joined(far, name)) == (near / name).read_bytes()
    assert (tmp_path / "far" / "catalogue.html").exists()
    again = ran([(tmp_path / "in").as_uri()], run)
    assert all(each.kept for each in again.values())
