"""Charts that meet themselves are cut, others are left alone."""

from __future__ import annotations

import numpy as np

from nispcodec.core.asset import TexturedMesh
from nispcodec.geometry.chart_cuts import split_self_seams
from nispcodec.geometry.charts import Charts, split_charts
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import box_asset, hemisphere, soup


def unrolled(turns: float = 1.0, columns: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """A cylinder, or an arc of one, and its unrolled UVs."""
    u = np.linspace(0, turns, columns + 1)
    angle = 2 * np.pi * u
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1).round(9)
    low, high = (np.column_stack([ring, np.full(columns + 1, z)]) for z in (0.0, 1.0))
    uv_low, uv_high = (np.column_stack([u, np.full(columns + 1, v)]) for v in (0.0, 1.0))

    def quads(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        first = np.stack([a[:-1], a[1:], b[1:]], axis=1)
        return np.concatenate([first, np.stack([a[:-1], b[1:], b[:-1]], axis=1)])

    return quads(low, high), quads(uv_low, uv_high)


def self_seams(mesh: TexturedMesh, charts: Charts) -> int:
    """Position edges whose two faces share a chart but not the UVs."""
    seen: dict[object, set[object]] = {}
    for chart, points, uvs in zip(charts.face_charts, mesh.corners, mesh.corner_uvs, strict=True):
        for i in range(3):
            ends = sorted(
                [(tuple(points[j]), tuple(uvs[j])) for j in (i, (i + 1) % 3)], key=lambda e: e[0]
            )
            places = (int(chart), *(end[0] for end in ends))
            seen.setdefault(places, set()).add(tuple(end[1] for end in ends))
    return sum(len(jumps) > 1 for jumps in seen.values())


def test_a_closed_cylinder_is_cut_in_two() -> None:
    mesh = soup(*unrolled())
    charts = split_charts(mesh, welded(mesh))
    assert (len(charts), self_seams(mesh, charts)) == (1, 1)
    cut = split_self_seams(mesh.corners, welded(mesh), charts)
    assert (len(cut), self_seams(mesh, cut)) == (2, 0)
    assert 4 < (cut.face_charts == 0).sum() < 20


def test_an_open_arc_stays_whole() -> None:
    mesh = soup(*unrolled(turns=0.8))
    charts = split_charts(mesh, welded(mesh))
    assert split_self_seams(mesh.corners, welded(mesh), charts) is charts


def test_a_dome_with_one_cut_from_pole_to_rim() -> None:
    """Seen from above in polar coordinates: the seam has a tip, where both sides are one corner."""
    triangles = hemisphere(8)
    angle = np.arctan2(triangles[..., 1], triangles[..., 0]) % (2 * np.pi)
    pole = np.hypot(triangles[..., 0], triangles[..., 1]) < 1e-6
    middle = np.where(pole, np.nan, angle)
    wide = np.nanmax(middle, axis=1) - np.nanmin(middle, axis=1) > np.pi
    angle[wide] = np.where(angle[wide] < np.pi, angle[wide] + 2 * np.pi, angle[wide])
    angle[pole] = 0
    mesh = soup(triangles, np.stack([angle, triangles[..., 2]], axis=2))
    charts = split_charts(mesh, welded(mesh))
    assert self_seams(mesh, charts) > 0
    assert self_seams(mesh, split_self_seams(mesh.corners, welded(mesh), charts)) == 0


def test_charts_of_a_box_and_their_materials_are_left_alone() -> None:
    charts = split_charts(box_asset(), welded(box_asset()))
    assert split_self_seams(box_asset().corners, welded(box_asset()), charts) is charts


def test_a_cut_chart_keeps_its_material() -> None:
    triangles, uvs = unrolled()
    mesh = soup(triangles, uvs)
    cut = split_self_seams(mesh.corners, welded(mesh), split_charts(mesh, welded(mesh)))
    assert cut.materials.tolist() == [0, 0]
    assert cut.has_uv.all()
