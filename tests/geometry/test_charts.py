"""Charts: patches connected through shared (material, position, uv) corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.geometry.charts import split_charts
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import box_asset, cube, soup


def test_the_sides_of_the_box_are_six_charts_of_two_materials() -> None:
    charts = split_charts(box_asset(), welded(box_asset()))
    assert charts.face_charts.tolist() == np.repeat(range(6), 2).tolist()
    assert charts.materials.tolist() == [0, 0, 0, 1, 1, 1]
    assert charts.has_uv.all()


def test_charts_connect_by_value_whether_or_not_vertices_are_shared() -> None:
    bare = soup(cube((0, 0, 0), 1.0))
    assert len(split_charts(bare, welded(bare))) == 1


def test_a_material_border_splits_a_chart() -> None:
    mesh = soup(cube((0, 0, 0), 1.0))
    materials = mesh.face_materials.copy()
    materials[:6] = 1
    mesh = replace(mesh, face_materials=materials)
    assert len(split_charts(mesh, welded(mesh))) == 2


def test_faces_without_uv_are_one_chart_a_material() -> None:
    mesh = soup(np.concatenate([cube((0, 0, 0), 1.0), cube((5, 0, 0), 1.0)]))
    bare = replace(mesh, uvs=np.zeros((0, 2)), uv_faces=np.full_like(mesh.uv_faces, -1))
    charts = split_charts(bare, welded(bare))
    assert len(charts) == 1
    assert not charts.has_uv.any()
