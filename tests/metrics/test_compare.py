from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array, IntArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.metrics.compare import compare
from nispcodec.metrics.psnr import CEILING
from tests.metrics.shapes import joined, moved, plane, sphere, textured

FEW = 4000
Nested = dict[str, Any]
"""A report, whose values are numbers or groups of numbers."""


def test_a_mesh_equals_itself() -> None:
    report: Nested = compare(sphere(), sphere(), samples=FEW)
    assert report["geometry"]["larger"]["max"] < 1e-12
    assert report["geometry"]["d1_psnr"] == report["geometry"]["d2_psnr"] == CEILING
    assert report["geometry"]["normal_consistency"] == pytest.approx(1)
    assert report["uv"]["larger"]["mean"] < 1e-9
    assert report["color"]["psnr"] > 90
    assert report["surface"] == {"hidden": 0, "sheet": 0}
    assert report["spurious"] == {"count": 0, "area": 0}
    assert report["parameterization"]["original"] == report["parameterization"]["decoded"]


def test_parallel_planes_lie_their_gap_apart() -> None:
    gap, radius = 0.01, np.sqrt(0.5)
    report: Nested = compare(plane(), plane(gap, cells=3), samples=FEW)
    for direction in ("original_to_decoded", "decoded_to_original", "larger"):
        for statistic in ("mean", "p99", "max"):
            assert report["geometry"][direction][statistic] == pytest.approx(gap / radius)
    expected = 10 * np.log10((np.sqrt(2) / radius) ** 2 / (gap / radius) ** 2)
    assert report["geometry"]["d1_psnr"] == pytest.approx(expected)
    assert report["geometry"]["d2_psnr"] == pytest.approx(expected)
    assert report["uv"]["larger"]["mean"] < 1e-9
    assert report["surface"]["sheet"] == 1


def test_sphere_of_another_radius() -> None:
    report: Nested = compare(sphere(1.0), sphere(1.03), samples=FEW)
    assert report["geometry"]["larger"]["mean"] == pytest.approx(0.03, rel=0.02)
    assert report["geometry"]["normal_consistency"] > 0.999


def test_distances_do_not_depend_on_the_unit() -> None:
    small = compare(sphere(1.0), sphere(1.03), samples=FEW)
    large = compare(sphere(50.0), sphere(51.5), samples=FEW)
    assert large["geometry"]["larger"] == pytest.approx(small["geometry"]["larger"])


def test_shift_is_caught() -> None:
    flat = moved(plane(), (0, 0, 1e-3))
    report: Nested = compare(plane(), flat, samples=FEW)
    assert report["geometry"]["larger"]["mean"] == pytest.approx(1e-3 / np.sqrt(0.5))
    ball = moved(sphere(), (1e-3, 0, 0))
    beside: Nested = compare(sphere(), ball, samples=FEW)
    assert beside["geometry"]["larger"]["mean"] == pytest.approx(5e-4, rel=0.1)
    assert beside["uv"]["larger"]["mean"] > 1e-4


def test_sliding_in_the_plane_is_no_distance_but_a_uv_error() -> None:
    slid = moved(plane(cells=1), (1e-3, 0, 0))
    report: Nested = compare(plane(), slid, samples=FEW)
    assert report["geometry"]["larger"]["mean"] < 1e-5
    assert report["uv"]["larger"]["median"] == pytest.approx(1e-3)


def test_flipped_uv_is_caught() -> None:
    mesh = plane()
    flipped = dataclasses.replace(mesh, uvs=mesh.uvs * [1, -1] + [0, 1])
    report: Nested = compare(mesh, flipped, samples=FEW)
    assert report["uv"]["larger"]["mean"] == pytest.approx(0.5, rel=0.05)
    assert report["geometry"]["larger"]["max"] < 1e-12
    assert report["color"]["psnr"] < 10


def test_one_chart_moved_in_the_atlas_is_caught() -> None:
    whole = joined(plane(), moved(plane(), (1, 0, 0)))
    uvs = whole.uvs.copy()
    uvs[: len(uvs) // 2] += [0.25, 0]
    report: Nested = compare(whole, dataclasses.replace(whole, uvs=uvs), samples=FEW)
    assert report["uv"]["larger"]["mean"] == pytest.approx(0.125, rel=0.1)


class Halves:
    """Two charts, divided at world x = `border`, with the same UV: (x - 10, y) and (x - 11, y)."""

    chart_materials = np.array([0, 0])

    def __init__(self, border: float) -> None:
        self.border = border

    def charts(self, points: Float64Array) -> IntArray:
        return (points[:, 0] > self.border).astype(np.int32)

    def uv(self, points: Float64Array, *, charts: IntArray) -> Float64Array:
        return np.stack([points[:, 0] - 10 - charts, points[:, 1]], axis=1)


def test_chart_accuracy_asks_in_the_world_frame() -> None:
    mesh = joined(moved(plane(), (10, 0, 0)), moved(plane(), (11, 0, 0)))
    right = compare(mesh, mesh, samples=FEW, model=Halves(11))
    wrong = compare(mesh, mesh, samples=FEW, model=Halves(11.5))
    assert right["charts"]["accuracy"] == 1
    assert wrong["charts"]["accuracy"] == pytest.approx(0.75, abs=0.03)


def test_missing_part_shows_only_from_the_original() -> None:
    whole = joined(sphere(), moved(sphere(), (3, 0, 0)))
    report: Nested = compare(whole, sphere(), samples=FEW)
    assert report["geometry"]["decoded_to_original"]["max"] < 1e-12
    assert report["geometry"]["original_to_decoded"]["mean"] > 0.1


def test_hidden_walls_are_reported_and_do_not_count() -> None:
    whole = joined(sphere(1.0), sphere(0.5))
    report: Nested = compare(whole, sphere(1.0), samples=FEW)
    assert report["surface"]["hidden"] == pytest.approx(0.2, abs=0.02)
    assert report["geometry"]["larger"]["max"] < 1e-12


def test_same_seed_same_numbers() -> None:
    pair = sphere(), moved(sphere(), (1e-3, 0, 0))
    assert compare(*pair, samples=FEW, seed=3) == compare(*pair, samples=FEW, seed=3)
    assert compare(*pair, samples=FEW, seed=3) != compare(*pair, samples=FEW, seed=4)


def test_report_is_json() -> None:
    text = json.dumps(
        compare(sphere(), moved(sphere(), (1e-3, 0, 0)), samples=FEW), allow_nan=False
    )
    assert "larger" in json.loads(text)["geometry"]


def test_without_uv_there_is_no_uv_group() -> None:
    mesh = sphere()
    bare = dataclasses.replace(mesh, uv_faces=np.full_like(mesh.uv_faces, -1))
    report: Nested = compare(bare, mesh, samples=FEW)
    assert "uv" not in report
    assert "parameterization" not in report


def test_degenerate_faces_change_nothing() -> None:
    mesh = plane()
    spoilt = dataclasses.replace(
        mesh,
        faces=np.vstack([mesh.faces, [[0, 0, 1], [2, 2, 2]]]).astype(np.int32),
        uv_faces=np.vstack([mesh.uv_faces, [[0, 0, 1], [2, 2, 2]]]).astype(np.int32),
        face_materials=np.zeros(len(mesh.faces) + 2, dtype=np.int32),
    )
    assert compare(mesh, spoilt, samples=FEW) == compare(mesh, mesh, samples=FEW)


@pytest.mark.parametrize("broken", ["empty", "flat"])
def test_no_surface_is_an_error(broken: str) -> None:
    faces = np.zeros((0 if broken == "empty" else 2, 3), dtype=np.int32)
    nothing = textured(np.zeros((1, 3)), faces, np.zeros((1, 2)), "nothing")
    with pytest.raises(MeshError, match="nothing"):
        compare(nothing, plane(), samples=FEW)
    with pytest.raises(MeshError, match="nothing"):
        compare(plane(), nothing, samples=FEW)


def test_unreferenced_vertices_do_not_move_the_frame() -> None:
    mesh = plane()
    with_stray = dataclasses.replace(mesh, positions=np.vstack([mesh.positions, [[9, 9, 9]]]))
    other = moved(plane(), (0, 0, 1e-2))
    expected: TexturedMesh = mesh
    assert compare(with_stray, other, samples=FEW) == compare(expected, other, samples=FEW)
