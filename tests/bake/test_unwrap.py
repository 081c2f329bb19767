from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nispcodec.bake.unwrap import unwrap, with_collapsed_named
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import NispError
from nispcodec.geometry.charts import split_charts
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import cube as cube_triangles
from tests.geometry.shapes import soup
from tests.io.files import image, load_obj

TRIANGLE = TexturedMesh.geometry_only(np.eye(3), np.arange(3)[None], "m")
CUBE = (
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "mtllib a.mtl\nusemtl red\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\n"
    "usemtl blue\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
)
MTL = "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nmap_Kd w.png\n"


@pytest.fixture
def cube(tmp_path: Path) -> TexturedMesh:
    return load_obj(tmp_path, CUBE, a_mtl=MTL, w_png=image())


def test_every_face_gets_uvs_and_keeps_the_rest(cube: TexturedMesh) -> None:
    pytest.importorskip("xatlas")
    made = unwrap(cube)
    assert made.has_uv.all()
    assert made.uvs.min() >= 0
    assert made.uvs.max() <= 1
    np.testing.assert_array_equal(made.corners, cube.corners)
    np.testing.assert_array_equal(made.face_materials, cube.face_materials)
    assert [material.base_color for material in made.materials] == [(1, 0, 0, 1), (0, 0, 1, 1)]
    assert 2 <= len(split_charts(made, welded(made))) <= 6


def test_textures_of_the_old_atlas_go_with_a_warning(cube: TexturedMesh) -> None:
    pytest.importorskip("xatlas")
    made = unwrap(cube)
    assert made.textures == ()
    assert made.materials[1].maps == {}
    assert made.warnings == ("textures fit the old atlas only and are dropped: w.png",)


def test_without_xatlas_the_error_says_what_to_install(
    cube: TexturedMesh, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "xatlas", None)
    with pytest.raises(NispError, match=r"pip install 'nispcodec\[unwrap\]'"):
        unwrap(cube)


def test_small_parts_beside_large_ones_get_an_area() -> None:
    pytest.importorskip("xatlas")
    corners = np.concatenate([cube_triangles((0, 0, 0), 1.0), cube_triangles((3, 0, 0), 5e-4)])
    uvs = unwrap(soup(corners)).corner_uvs
    a, b = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    assert (np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) > 0).all()


def test_faces_without_an_area_in_the_atlas_are_counted() -> None:
    (warning,) = with_collapsed_named(TRIANGLE).warnings
    assert warning.startswith("unwrapping: 1 of 1 faces got no area in the atlas")
    laid = replace(TRIANGLE, uvs=np.eye(3)[:, :2].copy(), uv_faces=TRIANGLE.faces)
    assert with_collapsed_named(laid).warnings == ()
    line = replace(TRIANGLE, positions=np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0]]))
    assert with_collapsed_named(line).warnings == ()
