"""The counts of what is wrong with a mesh are 0 on a good one, and only there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.studies.decoder import naive
from benchmarks.studies.soundness import soundness
from nispcodec.core.arrays import IntArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.extract.meshing import textured_mesh
from tests import tiny

WRONG = ("cracks", "crowded_edges", "duplicate_vertices", "two_chart_triangles")


@pytest.fixture(scope="module")
def document() -> Document:
    return tiny.document()


@pytest.fixture(scope="module")
def mesh(document: Document) -> TexturedMesh:
    return textured_mesh(document, 24)[0]


def test_a_decode_has_nothing_wrong(document: Document, mesh: TexturedMesh) -> None:
    counts = soundness(document, mesh)
    assert counts["faces"] == len(mesh.faces)
    assert [counts[name] for name in WRONG] == [0, 0, 0, 0]


def test_a_uv_for_each_vertex_smears_across_the_seam(document: Document) -> None:
    assert soundness(document, naive(document, 24))["two_chart_triangles"] > 0


def with_faces(mesh: TexturedMesh, chosen: IntArray) -> TexturedMesh:
    return replace(
        mesh,
        faces=mesh.faces[chosen],
        uv_faces=mesh.uv_faces[chosen],
        face_materials=mesh.face_materials[chosen],
    )


def test_holes_doubled_faces_and_doubled_vertices_count(
    document: Document, mesh: TexturedMesh
) -> None:
    torn = with_faces(mesh, np.r_[1 : len(mesh.faces)])
    assert soundness(document, torn)["cracks"] == 3
    doubled = with_faces(mesh, np.r_[0, 0 : len(mesh.faces)])
    assert soundness(document, doubled)["crowded_edges"] == 3
    loose = replace(mesh, positions=np.vstack([mesh.positions, mesh.positions[:1]]))
    assert soundness(document, loose)["duplicate_vertices"] == 1
