from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.mesh_part import Placement
from nispcodec.extract.mesh_parts import face_charts, joined
from nispcodec.extract.meshing import textured_mesh
from nispcodec.infer.placements import PlacedTriangles
from tests import tiny
from tests.infer.parts import cube, part_of

MIRRORED = Placement(offset=(0.5, 0, 0), scale=0.5, mirrored=True, uv_scale=(2, 2))
PART = part_of(cube(0.4), charts=2, placements=(Placement(), MIRRORED))
MESHES = replace(tiny.document(), field=None, meshes=(PART,))


def test_every_copy_comes_back_as_it_is_asked() -> None:
    mesh = joined(MESHES, None)
    placed = PlacedTriangles.of((PART,))
    normalized = MESHES.frame.to_normalized(mesh.corners)
    np.testing.assert_allclose(normalized, placed.corners, atol=1e-12)
    np.testing.assert_allclose(mesh.corner_uvs, placed.uvs, atol=1e-12)
    np.testing.assert_array_equal(face_charts(MESHES), placed.charts)
    assert mesh.face_materials.tolist() == placed.chart_materials[placed.charts].tolist()
    assert mesh.materials == MESHES.materials


def test_a_mesh_alone_is_decoded_to_its_triangles() -> None:
    mesh, report = textured_mesh(MESHES)
    assert len(mesh.faces) == 24
    assert (report.resolution, report.dropped) == (0, 0)
    # Positions are shared by faces, as in the part: the surface stays closed.
    assert len(mesh.positions) == 2 * len(PART.positions)


def test_beside_a_field_its_faces_follow_the_fields() -> None:
    document = replace(tiny.document(), meshes=(PART,))
    alone, _ = textured_mesh(replace(document, meshes=()), 32)
    mesh, _ = textured_mesh(document, 32)
    assert len(mesh.faces) == len(alone.faces) + 24
    np.testing.assert_array_equal(mesh.corners[: len(alone.faces)], alone.corners)
    np.testing.assert_allclose(
        document.frame.to_normalized(mesh.corners[len(alone.faces) :]),
        PlacedTriangles.of((PART,)).corners,
        atol=1e-12,
    )


def test_mesh_parts_keep_their_faces_and_that_is_said() -> None:
    said = "24 are of triangles that the file holds, which are kept as they are"
    few, _ = textured_mesh(MESHES, faces=10)
    assert few.warnings == (f"expected at most 10 faces, found 24: {said}",)
    assert textured_mesh(MESHES, faces=24)[0].warnings == ()
    both = replace(tiny.document(), meshes=(PART,))
    for faces, missed in ((300, False), (20, True)):
        mesh, _ = textured_mesh(both, 32, faces=faces)
        assert (len(mesh.faces) > faces) is missed
        assert any(said in each for each in mesh.warnings) is missed


def test_faces_without_uv_stay_without() -> None:
    bare = replace(
        PART,
        uv_faces=np.full_like(PART.uv_faces, -1),
        chart_has_uv=np.zeros(2, np.bool_),
    )
    mesh = joined(replace(MESHES, meshes=(PART, bare)), None)
    assert mesh.has_uv.tolist() == [True] * 24 + [False] * 24
