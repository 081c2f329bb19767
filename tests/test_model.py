"""Queries in both frames, their refusals, and the textured mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable, Frame
from nispcodec.core.errors import QueryError
from nispcodec.core.texture import base_color, decode_image
from nispcodec.model import NispModel
from tests import tiny
from tests.extract.surfaces import assert_closed, assert_sound
from tests.tiny import field_of, varied

QUERIES = ("sdf", "normals", "charts", "uv", "color", "project")
FRAME = Frame((1.0, 2.0, 3.0), 2.0)


@pytest.fixture(scope="module")
def model() -> NispModel:
    return NispModel(tiny.document(frame=FRAME))


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    return np.random.default_rng(0).uniform(-1, 1, (300, 3))


def test_sdf_is_in_the_units_of_the_frame(model: NispModel, points: np.ndarray) -> None:
    expected = (np.abs(points).sum(axis=1) - 0.8) / np.sqrt(3)
    np.testing.assert_allclose(model.sdf(points, "normalized"), expected, atol=1e-6)
    world = FRAME.to_world(points)
    np.testing.assert_allclose(model.sdf(world), expected * FRAME.radius, atol=1e-5)


@pytest.mark.parametrize("query", ["normals", "charts", "uv", "color"])
def test_frames_agree(query: str, model: NispModel, points: np.ndarray) -> None:
    normalized = getattr(model, query)(points, "normalized")
    world = getattr(model, query)(FRAME.to_world(points))
    np.testing.assert_allclose(world, normalized, atol=1e-5)


def test_normals_are_unit_gradients(model: NispModel, points: np.ndarray) -> None:
    expected = np.sign(points) / np.sqrt(3)
    np.testing.assert_allclose(model.normals(points, "normalized"), expected, atol=1e-6)


def test_normals_of_a_flat_field_are_zero() -> None:
    flat = tiny.relu_network([(np.eye(3), np.zeros(3)), (np.zeros((1, 3)), np.ones(1))])
    flat_model = NispModel(tiny.document(flat))
    assert not flat_model.normals(np.ones((2, 3))).any()


def test_charts_and_uv(model: NispModel, points: np.ndarray) -> None:
    charts = (points[:, 0] > 0).astype(int)
    assert np.array_equal(model.charts(points, "normalized"), charts)
    expected = np.column_stack(
        [0.25 + points[:, 1] * 0.25 + 0.5 * charts, 0.25 + points[:, 2] * 0.25]
    )
    np.testing.assert_allclose(model.uv(points, "normalized"), expected, atol=1e-6)


def test_given_charts_override_the_predicted(model: NispModel, points: np.ndarray) -> None:
    ones = np.ones(len(points), np.int64)
    shift = model.uv(points, "normalized", ones) - model.uv(points, "normalized", 0 * ones)
    np.testing.assert_allclose(shift, np.tile([0.5, 0.0], (len(points), 1)), atol=1e-6)


def test_uv_map_and_charts_without_uv(points: np.ndarray) -> None:
    plain = tiny.document()
    table = ChartTable(
        field_of(plain).charts.materials, np.array([True, False]), (-1.0, 2.0), (4.0, 3.0)
    )
    moved = NispModel(varied(plain, charts=table)).uv(points, "normalized")
    original = NispModel(plain).uv(points, "normalized")
    left = points[:, 0] < 0
    np.testing.assert_allclose(moved[left], original[left] * [4, 3] + [-1, 2], atol=1e-5)
    assert not moved[~left].any()


def test_color_looks_the_texture_up(model: NispModel) -> None:
    # Chart 0 is textured red | green over blue | white: (u, v) = (0.25, 0.25) is blue.
    at = np.array([[-0.5, 0.0, 0.0]])
    np.testing.assert_allclose(model.color(at, "normalized"), [[0, 0, 1, 1]], atol=1e-6)


def test_color_of_a_plain_material_is_its_factor_in_srgb(model: NispModel) -> None:
    gray = model.color(np.array([[0.5, 0.0, 0.0]]), "normalized")
    np.testing.assert_allclose(gray, [[0.7354, 0.7354, 0.7354, 1]], atol=1e-3)


def test_color_without_uv_ignores_the_texture() -> None:
    plain = tiny.document()
    table = ChartTable(field_of(plain).charts.materials, np.array([False, True]))
    materials = (Material("a", (0.0, 1.0, 0.0, 0.5), maps=plain.materials[0].maps),) * 2
    color = NispModel(varied(replace(plain, materials=materials), charts=table)).color(
        [[-5.0, 0, 0]]
    )
    np.testing.assert_allclose(color, [[0, 1, 0, 0.5]], atol=1e-6)


def test_openings_have_no_color_of_their_own(model: NispModel, points: np.ndarray) -> None:
    table = replace(field_of(model.document).charts, has_uv=np.array([True, False]), openings=True)
    opened = NispModel(varied(model.document, charts=table))
    assert set(opened.charts(points, "normalized")) == {0, 1}
    uvs = opened.uv(points, "normalized", np.zeros(len(points), int))
    material, texture = model.document.materials[0], model.document.textures[0]
    expected = base_color(material, decode_image(texture), uvs)
    np.testing.assert_allclose(opened.color(points, "normalized"), expected, atol=1e-6)


def test_project_lands_on_the_surface(model: NispModel, points: np.ndarray) -> None:
    landed = model.project(points, "normalized")
    assert landed.dtype == np.float64
    assert np.abs(model.sdf(landed, "normalized")).max() < 1e-5
    world = model.project(FRAME.to_world(points))
    np.testing.assert_allclose(world, FRAME.to_world(landed), atol=1e-4)


@pytest.mark.parametrize("query", QUERIES)
def test_no_points_is_a_question_too(query: str, model: NispModel) -> None:
    assert len(getattr(model, query)(np.zeros((0, 3)))) == 0


@pytest.mark.parametrize("query", QUERIES)
@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros(3), r"shape \(n, 3\)"),
        (np.zeros((4, 2)), r"shape \(n, 3\)"),
        ([["a", "b", "c"]], r"shape \(n, 3\)"),
        (np.array([[0, 0, 0], [0, np.nan, 0]]), "row 1"),
        (np.array([[np.inf, 0, 0]]), "row 0"),
        (np.array([[1e300, 0, 0]]), "row 0"),
    ],
)
def test_bad_points_are_refused(
    query: str, points: np.ndarray, message: str, model: NispModel
) -> None:
    with pytest.raises(QueryError, match=message):
        getattr(model, query)(points)


def test_unknown_frame_is_refused(model: NispModel) -> None:
    with pytest.raises(QueryError, match="world, normalized"):
        model.sdf(np.zeros((1, 3)), "local")


def test_charts_of_wrong_shape_or_range_are_refused(model: NispModel) -> None:
    with pytest.raises(QueryError, match="charts"):
        model.uv(np.zeros((2, 3)), charts=np.array([0]))
    with pytest.raises(QueryError, match="charts"):
        model.uv(np.zeros((2, 3)), charts=np.array([0, 2]))


def test_mesh_is_in_the_world_and_textured(model: NispModel) -> None:
    mesh = model.to_mesh(40)
    assert_sound(mesh.positions, mesh.faces)
    assert np.abs(model.sdf(mesh.positions)).max() < 1e-4
    assert mesh.has_uv.all()
    left = mesh.face_materials == 0
    x = mesh.corners[:, :, 0] - FRAME.center[0]
    tolerance = 0.05 * FRAME.radius * 2.04 / 40
    assert (x[left] < tolerance).all()
    assert (x[~left] > -tolerance).all()
    # Both copies of a seam's vertex carry the UV of their own chart.
    direct = model.uv(mesh.corners.reshape(-1, 3), charts=np.repeat(mesh.face_materials, 3))
    np.testing.assert_allclose(mesh.corner_uvs.reshape(-1, 2), direct, atol=1e-6)
    # Each UV once, each position once: nothing is doubled but at seams.
    seam = np.intersect1d(mesh.faces[left], mesh.faces[~left])
    assert len(mesh.uvs) == len(mesh.positions) + len(seam)


def test_faces_bounds_the_mesh_and_keeps_its_seams(model: NispModel) -> None:
    mesh = model.to_mesh(64, faces=600)
    assert 300 < len(mesh.faces) <= 600
    assert_closed(mesh.faces)
    x = mesh.corners[:, :, 0] - FRAME.center[0]
    # Simplification may move the border, but by no more than a fifth of a cell: how far
    # depends on the order of the triangles.
    tolerance = 0.2 * FRAME.radius * 2.04 / 64
    assert (x[mesh.face_materials == 0] < tolerance).all()
    assert (x[mesh.face_materials == 1] > -tolerance).all()
    assert np.abs(model.sdf(mesh.corners.mean(axis=1), "world")).max() < 0.05
    assert len(model.to_mesh(16, faces=10**6).faces) == len(model.to_mesh(16).faces)


def test_error_sets_the_size_of_the_mesh(model: NispModel) -> None:
    ball = NispModel(tiny.document(tiny.sphere()))
    coarse, fine = ball.to_mesh(64, error=2e-3), ball.to_mesh(64, error=4e-4)
    assert 2 * len(coarse.faces) < len(fine.faces) < 10_000
    for mesh, error in ((coarse, 2e-3), (fine, 4e-4)):
        centers = ball.sdf(mesh.corners.mean(axis=1)) / ball.document.frame.radius
        assert 0.2 * error < np.abs(centers).mean() < 2 * error


def test_mesh_of_charts_without_uv() -> None:
    plain = tiny.document()
    table = ChartTable(field_of(plain).charts.materials, np.array([True, False]))
    mesh = NispModel(varied(plain, charts=table)).to_mesh(24)
    assert np.array_equal(mesh.has_uv, mesh.face_materials == 0)


def test_a_field_without_surface_gives_an_empty_mesh() -> None:
    layers = [(np.eye(3), np.zeros(3)), (np.zeros((1, 3)), np.ones(1))]
    everywhere_outside = tiny.relu_network(layers)
    for options in ({}, {"faces": 100}, {"error": 1e-3}):
        mesh = NispModel(tiny.document(everywhere_outside)).to_mesh(16, **options)
        assert mesh.faces.shape == (0, 3)
        assert mesh.positions.shape == (0, 3)


def test_geometry_only() -> None:
    plain = tiny.document()
    table = ChartTable(np.zeros(1, np.int32), np.zeros(1, np.bool_))
    bare = NispModel(varied(plain, charts=table, chart=None, uv=None))
    mesh = bare.to_mesh(24)
    assert (mesh.uv_faces == -1).all()
    assert not bare.uv(np.zeros((2, 3))).any()
    assert not bare.charts(np.zeros((2, 3))).any()


def test_parts_of_many_points_are_as_all_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    model = NispModel(tiny.document())
    points = np.random.default_rng(0).uniform(1, 3, (50, 3))
    whole = model.color(points), model.sdf(points)
    monkeypatch.setattr("nispcodec.model.PART", 7)
    np.testing.assert_array_equal(model.color(points), whole[0])
    np.testing.assert_array_equal(model.sdf(points), whole[1])
    points[33] = np.nan
    with pytest.raises(QueryError, match="in row 33"):
        model.sdf(points)
