"""Triangles on integer grids."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.connectivity import connected_faces
from nispcodec.simplify.errors import mesh_of
from nispcodec.simplify.quantize import Grid, charts_of, quantized
from nispcodec.simplify.triangles import Triangles, side_numbers
from tests.geometry import shapes
from tests.simplify.meshes import UNIT, ball, bare_ball, half_dressed_ball, sheet, triangles_of


@pytest.mark.parametrize("triangles", [ball(), sheet(), bare_ball(), half_dressed_ball()])
def test_rounding_moves_nothing_by_more_than_half_a_step(triangles: Triangles) -> None:
    part = quantized(triangles, 12, 11)
    assert len(part.faces) == len(triangles)
    moved = part.normalized()[part.faces] - triangles.corners
    assert np.abs(moved).max() <= part.step / 2 + 1e-12
    uvs = mesh_of(part).corner_uvs - triangles.corner_uvs
    assert np.abs(uvs).max() <= part.uv_step[0] / 2 + 1e-12


def test_every_bit_is_used() -> None:
    part = quantized(ball(), 9, 8)
    assert part.positions.min() == 0
    assert part.positions.max() == 511
    assert part.uvs.max() == 255


def test_edges_that_fall_together_are_collapsed_without_holes() -> None:
    part = quantized(ball(), 3, 3)
    assert len(part.faces) < len(ball())
    assert (part.faces != np.roll(part.faces, 1, axis=1)).all()
    edges = side_numbers(part.faces.astype(np.int64))
    assert (np.bincount(edges.ravel()) % 2 == 0).all()


def test_a_part_of_a_single_spot_keeps_its_faces() -> None:
    one = triangles_of(shapes.soup(np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]])))
    tiny = replace(one, positions=np.zeros_like(one.positions))
    assert len(quantized(tiny, 4, 4).faces) == 1


def test_charts_end_at_seams() -> None:
    part = quantized(ball(), 10, 10)
    assert len(part.chart_has_uv) == 2
    assert part.chart_has_uv.all()


def test_charts_end_at_materials_and_where_uvs_end() -> None:
    box = quantized(Triangles.of(shapes.box_asset(), UNIT), 10, 10)
    assert len(box.chart_materials) == 6
    assert sorted(box.chart_materials) == [0, 0, 0, 1, 1, 1]
    half = quantized(half_dressed_ball(), 10, 10)
    assert sorted(half.chart_has_uv) == [False, True]
    assert (half.uv_faces[~half.chart_has_uv[half.face_charts]] == -1).all()


def test_charts_that_touch_in_a_point_are_two() -> None:
    corners = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [-1, 0, 0], [0, -1, 0]]])
    touching = triangles_of(shapes.soup(corners.astype(float)))
    assert connected_faces(touching.faces).max() == 0
    assert charts_of(touching)[0].tolist() == [0, 1]


@pytest.mark.parametrize("bits", [0, 21])
def test_bits_that_no_file_holds_are_refused(bits: int) -> None:
    with pytest.raises(ValueError, match=f"bits: expected 1 to 20, found {bits}"):
        Grid.of(np.zeros((2, 3)), bits)
