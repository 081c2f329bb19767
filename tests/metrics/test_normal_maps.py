from __future__ import annotations

import dataclasses
import io

import numpy as np
import PIL.Image
import pytest

from nispcodec.core.asset import Material, Texture, TexturedMesh, TextureMap
from nispcodec.core.document import Frame
from nispcodec.metrics.compare import compare
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.normal_maps import angle_summary, normal_angles
from nispcodec.metrics.surface import Surface
from tests.metrics.shapes import plane

UNIT = Frame((0.0, 0.0, 0.0), 1.0)


def leaning(degrees: float, towards: float = 0.0) -> Texture:
    """A normal map that leans by an angle, towards u = 0, v = 90 or between, in steps of 1/255."""
    across, up = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    turn = np.radians(towards)
    normal = np.array([across * np.cos(turn), across * np.sin(turn), up])
    pixels = np.tile(np.rint((normal + 1) / 2 * 255).astype(np.uint8), (4, 4, 1))
    file = io.BytesIO()
    PIL.Image.fromarray(pixels).save(file, "PNG")
    return Texture("n.png", file.getvalue(), "image/png")


def mapped(
    texture: Texture, strength: float = 1.0, mesh: TexturedMesh | None = None
) -> TexturedMesh:
    material = Material(maps={"normal": TextureMap(0, strength=strength)})
    return dataclasses.replace(mesh or plane(), materials=(material,), textures=(texture,))


def angles(first: TexturedMesh, second: TexturedMesh) -> np.ndarray:
    original, decoded = Surface.of(first, UNIT), Surface.of(second, UNIT)
    points = original.sample(300, np.random.default_rng(0))
    return normal_angles(original, decoded, Matches(points, decoded.closest(points.positions)))


def test_equal_maps_differ_by_nothing() -> None:
    mesh = mapped(leaning(30, 50))
    assert angles(mesh, mesh).max() < 1e-5


@pytest.mark.parametrize(("first", "second", "apart"), [(0, 20, 20), (10, 35, 25), (-10, 10, 20)])
def test_angles_are_those_between_the_directions(first: int, second: int, apart: int) -> None:
    found = angles(mapped(leaning(first)), mapped(leaning(second)))
    assert len(found) == 300
    np.testing.assert_allclose(found, apart, atol=0.6)


def test_the_strength_of_a_map_counts() -> None:
    found = angles(mapped(leaning(45)), mapped(leaning(45), strength=0.0))
    np.testing.assert_allclose(found, 45, atol=0.6)


def test_another_layout_of_the_same_directions_is_no_difference() -> None:
    mesh = plane()
    turned = dataclasses.replace(mesh, uvs=np.column_stack([mesh.uvs[:, 1], -mesh.uvs[:, 0]]))
    mirrored = dataclasses.replace(mesh, uvs=mesh.uvs * (-1, 1))
    first = mapped(leaning(30, towards=0))
    np.testing.assert_allclose(angles(first, mapped(leaning(30, -90), mesh=turned)), 0, atol=0.6)
    np.testing.assert_allclose(angles(first, mapped(leaning(30, 180), mesh=mirrored)), 0, atol=0.6)
    np.testing.assert_allclose(angles(first, mapped(leaning(30), mesh=mirrored)), 60, atol=0.6)


def test_the_surfaces_themselves_do_not_count() -> None:
    mesh = plane()
    tilted = mesh.positions @ np.array([[1, 0, 0], [0, 1, 0.2], [0, -0.2, 1]]).T
    second = mapped(leaning(10), mesh=dataclasses.replace(mesh, positions=tilted))
    np.testing.assert_allclose(angles(mapped(leaning(10)), second), 0, atol=0.6)


def test_points_without_a_map_or_without_uvs_are_left_out() -> None:
    mesh = mapped(leaning(10))
    assert len(angles(mesh, plane())) == 0
    none = dataclasses.replace(mesh, uv_faces=np.full_like(mesh.uv_faces, -1))
    assert len(angles(mesh, none)) == 0
    flat = dataclasses.replace(mesh, uvs=np.zeros_like(mesh.uvs))
    assert len(angles(mesh, flat)) == 0


def test_the_report_has_them_where_both_have_a_map() -> None:
    mesh = mapped(leaning(10))
    report = compare(mesh, mapped(leaning(30)), samples=500)
    assert report["normal_map"] == pytest.approx({"mean": 20, "p99": 20, "max": 20}, abs=0.6)
    assert "normal_map" not in compare(mesh, plane(), samples=500)


def test_the_summary() -> None:
    found = angle_summary(np.arange(101.0))
    assert found == {"mean": 50, "p99": 99, "max": 100}
