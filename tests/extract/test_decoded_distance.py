"""Distances to the decoded surface are right near it, far from it, and where networks are wrong."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import nispcodec
from nispcodec.core.arrays import Float64Array
from nispcodec.core.document import Document
from nispcodec.core.errors import MeshError, QueryError
from nispcodec.core.network import Network
from nispcodec.extract.decoded_distance import DecodedDistance, sdf_grid
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.model import NispModel
from tests import tiny

CONFORMANCE = Path(__file__).parents[1] / "conformance"
CELLS = 48
SIZE = 0.8


def octahedron_distance(points: Float64Array) -> Float64Array:
    """Signed distance to |x| + |y| + |z| = SIZE, by its eight equal octants."""
    q = np.abs(points)
    inside = (q.sum(axis=1) - SIZE) / np.sqrt(3)
    corners = SIZE * np.eye(3)
    onto_plane = q - np.maximum(inside, 0)[:, None] / np.sqrt(3)
    over_face = (onto_plane >= 0).all(axis=1)
    edges = [_from_segment(q, corners[a], corners[b]) for a, b in ((0, 1), (1, 2), (2, 0))]
    return np.where((inside <= 0) | over_face, inside, np.min(edges, axis=0))


def _from_segment(points: Float64Array, a: Float64Array, b: Float64Array) -> Float64Array:
    along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.linalg.norm(points - a - along[:, None] * (b - a), axis=1)


def wrong_far_away() -> Network:
    """The octahedron's network, which sees another body where x > 1."""
    axes = np.vstack([np.eye(3), -np.eye(3), [[1.0, 0, 0]]])
    bias = np.array([0.0] * 6 + [-1.0])
    out = np.array([[1 / np.sqrt(3)] * 6 + [-9.0]])
    return tiny.relu_network([(axes, bias), (out, np.array([-SIZE / np.sqrt(3)]))])


@pytest.mark.parametrize("sdf", [None, wrong_far_away()], ids=["right", "wrong far away"])
def test_a_grid_has_exact_distances_in_world_units(sdf: Network | None) -> None:
    document = tiny.document(sdf=sdf)
    grid = sdf_grid(document, 16, CELLS)
    points = np.asarray(grid.origin) + grid.spacing * np.indices(grid.shape).reshape(3, -1).T
    normalized = document.frame.to_normalized(points)
    expected = octahedron_distance(normalized) * document.frame.radius
    assert normalized[:, 0].max() > 1.1
    assert np.abs(grid.values().ravel() - expected).max() < 0.03


def test_a_grid_is_around_its_surface() -> None:
    grid = NispModel(tiny.document()).sdf_grid(20, CELLS)
    assert grid.shape == (20, 20, 20)
    inside = np.argwhere(grid.values() < 0)
    assert (inside.min(axis=0) >= 3).all()
    assert (inside.max(axis=0) <= 16).all()
    center = np.asarray(grid.origin) + grid.spacing * 9.5
    assert np.allclose(center, tiny.document().frame.center, atol=0.01)


def with_meshes() -> Document:
    return nispcodec.load(CONFORMANCE / "mesh-uv-partly.nisp").document


def test_field_and_meshes_are_one() -> None:
    meshes, field = with_meshes(), tiny.document().field
    both = DecodedDistance(replace(meshes, field=field), CELLS)
    points = np.random.default_rng(0).uniform(-1, 1, (500, 3))
    alone = DecodedDistance(replace(meshes, field=field, meshes=()), CELLS)(points)
    expected = np.minimum(alone, PlacedMeshes(meshes.meshes).sdf(points))
    assert np.array_equal(both(points), expected)


def test_mesh_parts_alone_answer_as_the_model_does() -> None:
    document = with_meshes()
    points = np.random.default_rng(0).uniform(-1, 1, (500, 3)).astype(np.float32)
    found = DecodedDistance(document)(points.astype(np.float64))
    assert np.array_equal(found, NispModel(document).sdf(points, "normalized"))


@pytest.mark.parametrize("samples", [15, 1025, -1])
def test_absurd_sizes_are_refused(samples: int) -> None:
    with pytest.raises(QueryError, match=f"samples: expected 16 to 1024, found {samples}"):
        NispModel(tiny.document()).sdf_grid(samples)


def test_a_field_without_a_surface_has_no_distance() -> None:
    nothing = tiny.relu_network([(np.zeros((1, 3)), np.zeros(1)), (np.zeros((1, 1)), np.ones(1))])
    with pytest.raises(MeshError, match="expected a surface, found none"):
        NispModel(tiny.document(sdf=nothing)).sdf_grid(16, CELLS)
