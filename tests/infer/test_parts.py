from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.document import Document
from nispcodec.infer.field import FieldQueries
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.infer.parts import Union
from tests import tiny
from tests.infer.parts import cube, part_of
from tests.tiny import field_of

POINTS = np.random.default_rng(0).uniform(-1, 1, (500, 3)).astype(np.float32)
MESH = part_of(cube(0.3, (0.7, 0.7, 0.7)), charts=2)


@pytest.fixture(scope="module")
def both() -> Document:
    """An octahedron as a field, and a cube as a mesh in its corner."""
    return replace(tiny.document(), meshes=(MESH,))


def test_the_distance_is_the_least_of_all_parts(both: Document) -> None:
    field, mesh = FieldQueries(field_of(both)).sdf(POINTS), PlacedMeshes((MESH,)).sdf(POINTS)
    np.testing.assert_array_equal(Union(both).sdf(POINTS), np.minimum(field, mesh))
    assert (mesh < field).any()
    assert (field < mesh).any()


def test_looks_are_those_of_the_nearest_part(both: Document) -> None:
    union = Union(both)
    field, mesh = FieldQueries(field_of(both)), PlacedMeshes((MESH,))
    near = np.abs(field.sdf(POINTS)) <= np.abs(mesh.sdf(POINTS))
    charts = union.charts(POINTS)
    np.testing.assert_array_equal(charts[near], field.charts(POINTS[near]))
    np.testing.assert_array_equal(charts[~near], 2 + mesh.charts(POINTS[~near]))
    uvs = union.uv(POINTS, charts)
    np.testing.assert_array_equal(uvs[near], field.uv(POINTS[near], charts[near]))
    np.testing.assert_array_equal(uvs[~near], mesh.uv(POINTS[~near], charts[~near] - 2))
    landed = union.project(POINTS)
    np.testing.assert_array_equal(landed[~near], mesh.project(POINTS[~near]))


def test_normals_are_those_of_the_surface_that_gives_the_distance(both: Document) -> None:
    union = Union(both)
    step = np.float32(1e-3)
    risen = union.sdf(POINTS + step * union.normals(POINTS)) - union.sdf(POINTS)
    np.testing.assert_allclose(risen / step, 1, atol=0.02)


def test_charts_are_numbered_through(both: Document) -> None:
    assert Union(both).chart_count == len(both.chart_materials) == 4
    assert both.chart_has_uv.tolist() == [True] * 4


@pytest.mark.parametrize("kind", ["field", "mesh"])
def test_one_part_alone_answers_as_it_is(both: Document, kind: str) -> None:
    alone = replace(both, meshes=()) if kind == "field" else replace(both, field=None)
    queries = FieldQueries(field_of(both)) if kind == "field" else PlacedMeshes((MESH,))
    union = Union(alone)
    np.testing.assert_array_equal(union.sdf(POINTS), queries.sdf(POINTS))
    np.testing.assert_array_equal(union.charts(POINTS), queries.charts(POINTS))


def test_no_points_no_answers(both: Document) -> None:
    none = POINTS[:0]
    union = Union(both)
    assert union.sdf(none).shape == (0,)
    assert union.normals(none).shape == (0, 3)
    assert union.uv(none, union.charts(none)).shape == (0, 2)
