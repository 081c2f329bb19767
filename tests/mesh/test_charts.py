"""Charts: patches connected through shared (material, position, uv) corners."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.mesh.charts import Charts, merge_distant, split_charts
from tests.mesh.shapes import box_asset, cube, soup


def test_the_sides_of_the_box_are_six_charts_of_two_materials() -> None:
    charts = split_charts(box_asset())
    assert charts.face_charts.tolist() == np.repeat(range(6), 2).tolist()
    assert charts.materials.tolist() == [0, 0, 0, 1, 1, 1]
    assert charts.has_uv.all()


def test_charts_connect_by_value_whether_or_not_vertices_are_shared() -> None:
    assert len(split_charts(soup(cube((0, 0, 0), 1.0)))) == 1


def test_a_material_border_splits_a_chart() -> None:
    mesh = soup(cube((0, 0, 0), 1.0))
    materials = mesh.face_materials.copy()
    materials[:6] = 1
    assert len(split_charts(replace(mesh, face_materials=materials))) == 2


def test_faces_without_uv_are_one_chart_a_material() -> None:
    mesh = soup(np.concatenate([cube((0, 0, 0), 1.0), cube((5, 0, 0), 1.0)]))
    bare = replace(mesh, uvs=np.zeros((0, 2)), uv_faces=np.full_like(mesh.uv_faces, -1))
    charts = split_charts(bare)
    assert len(charts) == 1
    assert not charts.has_uv.any()


def line_of_charts(count: int, materials: list[int]) -> tuple[Charts, np.ndarray, np.ndarray]:
    """Charts that are points on a line, one apart."""
    numbers = np.arange(count, dtype=np.int32)
    points = np.column_stack([numbers, np.zeros(count), np.zeros(count)]).astype(float)
    kinds = np.array(materials, np.int32)
    return Charts(numbers, kinds, np.ones(count, bool)), points, numbers


@given(st.lists(st.integers(0, 2), min_size=1, max_size=30), st.floats(0.1, 6))
def test_merged_charts_keep_apart_what_is_near_and_what_differs(
    materials: list[int], gap: float
) -> None:
    charts, points, numbers = line_of_charts(len(materials), materials)
    merged = merge_distant(charts, points, numbers, gap)
    assert merged.materials[merged.face_charts].tolist() == materials
    for one, label in enumerate(merged.face_charts):
        near = [n for n in range(len(materials)) if n != one and abs(n - one) <= gap]
        assert label not in merged.face_charts[near]


def test_charts_far_apart_share_a_number() -> None:
    charts, points, numbers = line_of_charts(100, [0] * 100)
    assert len(merge_distant(charts, points, numbers, 1.5)) <= 6
