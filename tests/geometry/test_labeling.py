from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.charts import split_charts
from nispcodec.geometry.labeling import chart_table
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import box_asset
from tests.samplers import analysis_of


@pytest.fixture(scope="module")
def box() -> Analysis:
    """Its UVs shifted, so that the file needs a map to them."""
    mesh = box_asset()
    return analysis_of(dataclasses.replace(mesh, uvs=3 * mesh.uvs - [1, 0.5]))


def above(box: Analysis, height: float) -> tuple[Float64Array, Float64Array]:
    """Points (12, 3) over the middle of each face, normalized frame, and the UVs there."""
    corners = box.frame.to_normalized(box.mesh.corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return corners.mean(axis=1) + height * normals, box.mesh.corner_uvs.mean(axis=1)


@pytest.mark.parametrize("height", [0.1, 0.0, -0.05])
def test_labels_are_those_of_the_closest_point(box: Analysis, height: float) -> None:
    points, uvs = above(box, height)
    labels = box.label(points)
    np.testing.assert_allclose(labels.sdf, height, atol=1e-6)
    np.testing.assert_array_equal(labels.chart, box.patches.face_charts)
    placed = labels.uv * box.table.uv_scale + box.table.uv_offset
    np.testing.assert_allclose(placed, uvs, atol=1e-6)
    assert {each.dtype.name for each in (labels.points, labels.sdf, labels.uv)} == {"float32"}
    np.testing.assert_array_equal(labels.points, points.astype(np.float32))


def test_unsigned_all_of_space_is_outside(box: Analysis) -> None:
    points, _ = above(box, -0.05)
    signed, unsigned = box.label(points), box.label(points, signed=False)
    np.testing.assert_allclose(unsigned.sdf, -signed.sdf, atol=1e-6)
    np.testing.assert_array_equal(unsigned.chart, signed.chart)
    np.testing.assert_array_equal(unsigned.uv, signed.uv)


def test_charts_without_uv_are_labeled_with_zeros() -> None:
    mesh = box_asset()
    uv_faces = mesh.uv_faces.copy()
    uv_faces[:6] = -1
    box = analysis_of(dataclasses.replace(mesh, uv_faces=uv_faces, uvs=mesh.uvs + 1))
    uvs = box.label(above(box, 0.1)[0]).uv
    assert (uvs[:6] == 0).all()
    assert (uvs[6:] > 0).any(axis=1).all()


def table_of(mesh: TexturedMesh, filled: float = 0.5) -> tuple[Float64Array, Float64Array]:
    table = chart_table(mesh, split_charts(mesh, welded(mesh)), filled)
    return np.array(table.uv_offset), np.array(table.uv_scale)


@pytest.mark.parametrize(("scale", "shift"), [(3.0, -1.0), (1.0, 0.2), (0.25, 0.5)])
def test_used_uvs_fill_the_unit_square(scale: float, shift: float) -> None:
    """UVs that no face has are none of its business."""
    mesh = box_asset()
    mesh = dataclasses.replace(mesh, uvs=np.vstack([mesh.uvs * scale + shift, [[99.0, -99.0]]]))
    offset, factor = table_of(mesh)
    uvs = ((mesh.corner_uvs - offset) / factor).reshape(-1, 2)
    np.testing.assert_allclose(uvs.min(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(uvs.max(axis=0), 1)


@pytest.mark.parametrize(("filled", "same"), [(0.94, True), (0.96, False)])
def test_an_atlas_that_is_filled_enough_needs_no_map(filled: float, same: bool) -> None:
    """The box fills 0.967 of its atlas in u and 0.95 in v."""
    offset, scale = table_of(box_asset(), filled)
    assert (offset.tolist() == [0, 0] and scale.tolist() == [1, 1]) == same


def test_uvs_on_a_line_or_nowhere_have_a_map_that_can_be_inverted() -> None:
    mesh = box_asset()
    line = dataclasses.replace(mesh, uvs=mesh.uvs * [0, 2] + [5, 0])
    offset, scale = table_of(line)
    assert (offset[0], scale[0]) == (5, 1)
    none = dataclasses.replace(mesh, uv_faces=mesh.uv_faces * 0 - 1)
    offset, scale = table_of(none)
    assert (offset.tolist(), scale.tolist()) == ([0, 0], [1, 1])
