"""Levels of detail: of a field, of triangles, and of both, from one extraction."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
import trimesh

from nispcodec.core.document import Document
from nispcodec.core.errors import NispError, QueryError
from nispcodec.core.network import Network
from nispcodec.extract.isosurface import extract
from nispcodec.extract.meshing import textured_levels
from nispcodec.geometry.triangles import area
from nispcodec.model import NispModel
from tests import tiny
from tests.extract.surfaces import assert_closed
from tests.infer.parts import cube, part_of


def ball() -> Document:
    """A sphere of 1,280 triangles."""
    part = part_of(np.asarray(trimesh.creation.icosphere(3, 0.6).triangles))
    return replace(tiny.document(), field=None, meshes=(part,))


def counts(document: Document, levels: int = 3) -> list[int]:
    meshes, _ = textured_levels(document, levels, 48)
    return [len(mesh.faces) for mesh in meshes]


@pytest.fixture
def simplifier() -> None:
    for package in ("meshoptimizer", "igl", "scipy"):
        pytest.importorskip(package, reason="the extra `encode` is not installed")


@pytest.mark.parametrize("kind", ["field", "triangles", "both"])
def test_each_level_has_about_a_quarter(kind: str, simplifier: None) -> None:
    documents = {"field": tiny.document(tiny.sphere()), "triangles": ball()}
    both = replace(documents["field"], meshes=documents["triangles"].meshes)
    finest, middle, coarsest = counts(documents.get(kind, both))
    assert 0.2 * finest < middle <= 0.27 * finest
    assert 0.15 * middle < coarsest <= 0.3 * middle


def test_the_first_level_is_the_plain_mesh() -> None:
    model = NispModel(tiny.document())
    (alone,) = model.to_lods(1, 32)
    first, second = model.to_lods(2, 32)
    plain = model.to_mesh(32)
    for mesh in (alone, first):
        np.testing.assert_array_equal(mesh.corners, plain.corners)
        np.testing.assert_array_equal(mesh.corner_uvs, plain.corner_uvs)
    assert second.textures == plain.textures
    assert second.materials == plain.materials


def test_there_is_one_extraction(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Mock(wraps=extract)
    monkeypatch.setattr("nispcodec.extract.meshing.extract", asked)
    counts(tiny.document(tiny.sphere()), 4)
    asked.assert_called_once()


def test_no_level_is_a_part_of_a_sheet(simplifier: None) -> None:
    places = np.indices((5, 5)).reshape(2, -1).T / 4 - 0.5
    first = np.arange(20).reshape(4, 5)[:, :4].reshape(-1, 1)
    faces = np.concatenate([first + np.array([0, 5, 6]), first + np.array([0, 6, 1])])
    part = part_of(np.column_stack([places, np.zeros(25)])[faces])
    meshes, _ = textured_levels(replace(tiny.document(), field=None, meshes=(part,)), 5)
    areas = [area(mesh.corners).sum() for mesh in meshes]
    np.testing.assert_allclose(areas, areas[0], rtol=0.01)


def test_levels_of_a_closed_surface_are_closed(simplifier: None) -> None:
    for document in (tiny.document(tiny.sphere()), ball()):
        for mesh in textured_levels(document, 3, 48)[0]:
            assert_closed(mesh.faces)


@pytest.mark.parametrize("network", [tiny.octahedron(), tiny.sphere()])
def test_there_is_a_coarsest_level(network: Network) -> None:
    meshes, _ = textured_levels(tiny.document(network), 8, 48)
    faces = [len(mesh.faces) for mesh in meshes]
    assert faces == sorted(faces, reverse=True)
    for mesh in meshes:
        size, whole = (np.ptp(each.positions, axis=0) for each in (mesh, meshes[0]))
        assert (size > 0.5 * whole).all()


def test_levels_keep_what_is_hard(simplifier: None) -> None:
    document = replace(tiny.document(), field=None, meshes=(part_of(cube(0.4), charts=2),))
    first, second = NispModel(document).to_lods(2)
    assert first.creases is not None
    assert second.creases is not None
    assert second.creases.any()


def test_without_the_packages_a_sentence_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("nispcodec.core.extras.find_spec", lambda name: None)
    assert len(counts(ball(), 1)) == 1
    with pytest.raises(NispError, match=r"nispcodec\[encode\]"):
        counts(ball(), 2)


def test_no_level_is_refused() -> None:
    with pytest.raises(QueryError, match="expected at least 1, found 0"):
        NispModel(tiny.document()).to_lods(0)
