from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array, Int64Array, IntArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import QueryError
from nispcodec.metrics.charts import chart_accuracy
from nispcodec.metrics.color import color_at
from nispcodec.metrics.parameterization import distortion_summary, triangle_distortions
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.metrics.psnr import CEILING, psnr
from nispcodec.metrics.spurious import components, spurious_components
from nispcodec.metrics.surface import Surface, frame_of
from tests.metrics.shapes import joined, moved, plane, sphere, textured


def surface_of(mesh: TexturedMesh) -> Surface:
    return Surface.of(mesh, frame_of(mesh))


def test_frame_puts_the_box_at_zero_and_the_farthest_vertex_at_one() -> None:
    mesh = moved(sphere(3.0), (5, -2, 1))
    positions = surface_of(mesh).positions
    np.testing.assert_allclose(positions.min(axis=0) + positions.max(axis=0), 0, atol=1e-12)
    assert np.linalg.norm(positions, axis=1).max() == pytest.approx(1)


def test_samples_lie_on_the_surface_and_spread_by_area() -> None:
    surface = surface_of(joined(sphere(1.0), moved(sphere(0.5), (3, 0, 0))))
    points = surface.sample(20_000, np.random.default_rng(0))
    on_small = (points.faces >= len(surface.mesh.faces) // 2).mean()
    assert on_small == pytest.approx(0.2, abs=0.01)
    back = surface.closest(points.positions)
    np.testing.assert_allclose(back.positions, points.positions, atol=1e-9)


def test_closest_point_and_its_weights_agree() -> None:
    surface = surface_of(sphere())
    points = np.random.default_rng(0).normal(size=(500, 3))
    found = surface.closest(points)
    np.testing.assert_allclose(
        surface.interpolate(found.faces, found.weights), found.positions, atol=1e-9
    )
    assert (found.weights >= 0).all()


def test_weights_are_numbers_beside_faces_that_are_lines_but_for_rounding() -> None:
    """As coordinates of three digits leave them."""
    rng = np.random.default_rng(0)
    starts, ways = rng.integers(-500, 500, (300, 3)), rng.integers(-50, 50, (300, 3))
    lines = np.stack([starts, starts + ways, starts + 3 * ways], axis=1).reshape(-1, 3) / 1000
    corners = np.vstack([lines, np.eye(3)])
    surface = surface_of(
        textured(corners, np.arange(len(corners)).reshape(-1, 3), corners[:, :2], "lines")
    )
    found = surface.closest(surface.positions + rng.normal(scale=1e-3, size=corners.shape))
    np.testing.assert_allclose(
        surface.interpolate(found.faces, found.weights), found.positions, atol=1e-6
    )


def test_distortion_of_a_known_map() -> None:
    # Two units wide and half a unit high onto the unit square: sigmas 1/2 and 2.
    positions = np.array([[0, 0, 0], [2, 0, 0], [2, 0.5, 0], [0, 0.5, 0]], dtype=float)
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], dtype=float)
    mesh = textured(positions, np.array([[0, 1, 2], [0, 2, 3]]), uvs, "sheet")
    surface = Surface(mesh, mesh.positions)
    np.testing.assert_allclose(triangle_distortions(surface), 2)
    assert distortion_summary(surface) == pytest.approx(
        {"mean": 2, "max": 2, "std": 0, "collapsed": 0}
    )


def test_collapsed_uv_is_counted_apart() -> None:
    mesh = plane(cells=1)
    uvs = np.where(np.arange(4)[:, None] == 1, mesh.uvs[0], mesh.uvs)
    summary = distortion_summary(surface_of(textured(mesh.positions, mesh.faces, uvs, "half")))
    assert summary["collapsed"] == 0.5
    assert np.isfinite(list(summary.values())).all()


def test_mirrored_uv_has_the_same_distortion() -> None:
    mesh = sphere()
    mirrored = textured(mesh.positions, mesh.faces, mesh.uvs * [-1, 1], "mirrored")
    np.testing.assert_allclose(
        triangle_distortions(surface_of(mirrored)), triangle_distortions(surface_of(mesh))
    )


def test_components_weld_equal_positions() -> None:
    mesh = plane(cells=2)
    soup = textured(mesh.corners.reshape(-1, 3), np.arange(24).reshape(8, 3), np.zeros((24, 2)), "")
    assert components(soup).max() == 0
    assert components(joined(mesh, moved(mesh, (5, 0, 0)))).max() == 1


def test_spurious_component_is_found_and_measured() -> None:
    body, blob = sphere(), moved(sphere(0.05), (0.9, 0.9, 0.9))
    assert spurious_components(body, body) == {"count": 0, "area": 0}
    found = spurious_components(joined(body, blob), body)
    assert found["count"] == 1
    assert found["area"] == pytest.approx(4 * np.pi * 0.05**2, rel=0.02)


def test_component_that_touches_the_surface_is_not_spurious() -> None:
    bump = moved(sphere(0.05), (1, 0, 0))
    assert spurious_components(joined(sphere(), bump), sphere())["count"] == 0


class Halves:
    """Chart 0 where x < border, 1 elsewhere; chart c has the UV (x, y + c), or none."""

    chart_materials = np.array([0, 1])

    def __init__(self, border: float = 0.0, textured: bool = True) -> None:
        self.border, self.textured = border, textured

    def charts(self, points: Float64Array) -> IntArray:
        return (points[:, 0] >= self.border).astype(np.int32)

    def uv(self, points: Float64Array, *, charts: IntArray) -> Float64Array:
        return (points[:, :2] + np.stack([0 * charts, charts], axis=1)) * self.textured


class AlikeHalves(Halves):
    """Both charts have the UV (x, y), and one material."""

    chart_materials = np.array([0, 0])

    def uv(self, points: Float64Array, *, charts: IntArray) -> Float64Array:
        return points[:, :2]


def halves_points() -> tuple[Float64Array, Int64Array]:
    """Points, and the side of x = 0 that they are on."""
    points = np.random.default_rng(0).uniform(-1, 1, (4000, 3))
    return points, (points[:, 0] >= 0).astype(int)


@pytest.mark.parametrize(("border", "share"), [(0.0, 1.0), (0.5, 0.75)])
def test_a_chart_is_right_when_its_uv_is(border: float, share: float) -> None:
    points, side = halves_points()
    uvs = Halves().uv(points, charts=side)
    found = chart_accuracy(Halves(border), points, uvs, side)
    assert found == pytest.approx(share, abs=0.03)


def test_swapped_charts_are_all_wrong() -> None:
    points, side = halves_points()
    swapped = Halves().uv(points, charts=1 - side)
    assert chart_accuracy(Halves(), points, swapped, side) == 0


def test_without_uv_the_material_decides() -> None:
    points, side = halves_points()
    model = Halves(border=0.1, textured=False)
    found = chart_accuracy(model, points, np.zeros((4000, 2)), side)
    assert found == pytest.approx(0.95, abs=0.02)


def test_charts_that_agree_on_the_uv_are_both_right() -> None:
    points, side = halves_points()
    assert chart_accuracy(AlikeHalves(border=0.5), points, points[:, :2], 0 * side) == 1


def test_psnr_of_known_error_and_of_none() -> None:
    assert psnr(0.01, 1.0) == pytest.approx(20)
    assert psnr(0.0, 1.0) == CEILING


def test_pictures() -> None:
    picture = np.random.default_rng(0).random((32, 32, 3)).astype(np.float32)
    same = compare_pictures(picture, picture)
    assert same == pytest.approx({"psnr": CEILING, "ssim": 1})
    darker = compare_pictures(picture, picture * np.float32(0.5))
    assert darker["psnr"] < 15
    assert darker["ssim"] < 0.9


def test_pictures_of_different_shapes_are_refused() -> None:
    with pytest.raises(QueryError, match="shape"):
        compare_pictures(np.zeros((8, 8, 3), np.float32), np.zeros((8, 9, 3), np.float32))


def test_faces_without_uv_show_the_factor() -> None:
    mesh = plane(cells=1)
    uv_faces = mesh.uv_faces.copy()
    uv_faces[0] = -1
    surface = surface_of(dataclasses.replace(mesh, uv_faces=uv_faces))
    points = surface.sample(400, np.random.default_rng(0))
    colors = color_at(surface, points)
    np.testing.assert_allclose(colors[points.faces == 0], 1, atol=1e-6)
    assert set(np.unique(colors[points.faces == 1][:, 0].round(6))) >= {0.0, 1.0}
