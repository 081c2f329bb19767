"""The public names: each does what its first line says, from paths as from objects."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nispcodec
from nispcodec.procedural.mug import sample_asset
from tests import tiny
from tests.encode.tunings import small
from tests.geometry.shapes import box_asset


@pytest.fixture
def model() -> nispcodec.NispModel:
    return nispcodec.NispModel(tiny.document())


def test_every_public_name_is_there() -> None:
    assert all(hasattr(nispcodec, name) for name in nispcodec.__all__)
    assert callable(nispcodec.render)
    assert callable(nispcodec.encode)


def test_a_mesh_goes_to_a_file_and_comes_back(tmp_path: Path) -> None:
    mesh = sample_asset()
    written = mesh.save(tmp_path / "mug.obj")
    assert written[-1] == tmp_path / "mug.obj"
    again = nispcodec.load_mesh(str(tmp_path / "mug.obj"))
    assert len(again.faces) == len(mesh.faces)
    assert nispcodec.write_mesh(again, tmp_path / "mug.glb") == [tmp_path / "mug.glb"]


def test_comparing_takes_paths_meshes_and_models(
    model: nispcodec.NispModel, tmp_path: Path
) -> None:
    mesh = model.to_mesh(24)
    mesh.save(tmp_path / "octahedron.glb")
    reports = [
        nispcodec.compare(tmp_path / "octahedron.glb", decoded)
        for decoded in (mesh, str(tmp_path / "octahedron.glb"), model)
    ]
    for report in reports:
        distance = report["geometry"]["larger"]
        assert isinstance(distance, dict)
        assert distance["mean"] < 0.05
    assert "charts" in reports[2]


def test_pictures_of_models_and_meshes_show_the_same(model: nispcodec.NispModel) -> None:
    traced = nispcodec.render(model, "front", 32)
    cast = nispcodec.render(model.to_mesh(48), "front", 32)
    assert traced.shape == cast.shape == (32, 32, 4)
    assert traced[16, 16, 3] == cast[16, 16, 3] == 1
    assert traced[0, 0, 3] == cast[0, 0, 3] == 0


def test_a_new_image_is_in_the_file(model: nispcodec.NispModel, tmp_path: Path) -> None:
    image = tiny.png(np.full((2, 2, 3), 7, np.uint8))
    (tmp_path / "new.png").write_bytes(image.data)
    again = nispcodec.retexture(model, "base_color", tmp_path / "new.png")
    nispcodec.save(again, tmp_path / "new.nisp")
    textures = nispcodec.load(tmp_path / "new.nisp").document.textures
    assert [texture.data for texture in textures] == [image.data]


def test_an_image_that_is_not_there_is_an_error(model: nispcodec.NispModel) -> None:
    with pytest.raises(nispcodec.NispError, match=r"nowhere\.png: cannot be read"):
        nispcodec.retexture(model, "base_color", "nowhere.png")


@pytest.mark.parametrize("given", [None, 3, b"model.obj", [1, 2]])
def test_encoding_something_else_is_a_type_error(given: Any) -> None:
    with pytest.raises(TypeError, match="expected a TexturedMesh or the path of a mesh file"):
        nispcodec.encode(given)


def test_encoding_a_path_that_is_not_there_names_it() -> None:
    with pytest.raises(nispcodec.MeshError, match=r"nowhere\.obj"):
        nispcodec.encode("nowhere.obj")


def holed() -> nispcodec.TexturedMesh:
    """A cube with a face the wrong way round."""
    mesh = box_asset()
    faces = mesh.faces.copy()
    faces[0] = faces[0, ::-1]
    return replace(mesh, faces=faces)


def test_what_was_done_about_a_mesh_is_a_python_warning() -> None:
    tuning = small(300, 100, 0, 100, 20)
    with pytest.warns(nispcodec.NispWarning, match="turned faces") as caught:
        nispcodec.encode(holed(), tuning=tuning)
    assert {each.filename for each in caught} == {__file__}


def test_a_listener_hears_it_instead(recwarn: pytest.WarningsRecorder) -> None:
    heard: list[str] = []
    tuning = small(300, 100, 0, 100, 20)
    nispcodec.encode(holed(), progress=lambda told: heard.append(told.warning), tuning=tuning)
    assert any("turned faces" in each for each in heard)
    assert not [each for each in recwarn if each.category is nispcodec.NispWarning]


def test_what_is_left_out_of_a_file_is_a_python_warning(tmp_path: Path) -> None:
    path = tmp_path / "a.obj"
    nispcodec.write_mesh(box_asset(), path)
    path.write_text(path.read_text() + "usemtl nowhere\nf 1 2 3\n")
    with pytest.warns(nispcodec.NispWarning, match="material 'nowhere' is in no material file"):
        nispcodec.encode(path, tuning=small(300, 100, 0, 100, 20))


def test_what_a_format_cannot_hold_is_a_python_warning(
    tmp_path: Path, recwarn: pytest.WarningsRecorder
) -> None:
    plain = box_asset()
    masked = tuple(replace(each, alpha_mode="mask") for each in plain.materials)
    mesh = replace(plain, materials=masked)
    mesh.save(tmp_path / "a.glb")
    assert not recwarn.list
    for write in (mesh.save, partial(nispcodec.write_mesh, mesh)):
        with pytest.warns(nispcodec.NispWarning, match="left out alpha modes") as caught:
            write(tmp_path / "a.obj")
        assert {each.filename for each in caught} == {__file__}
