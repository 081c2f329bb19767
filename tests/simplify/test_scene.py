"""Meshes with their copies."""

from __future__ import annotations

import numpy as np

from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.scene import placed, scene
from tests.simplify.meshes import ball, half_dressed_ball
from tests.simplify.scenes import PLACES


def test_a_mesh_in_its_place_is_itself() -> None:
    mesh = ball().mesh()
    assert scene([(mesh, (Placement(),))]) is mesh


def test_faces_of_every_copy_look_outwards() -> None:
    mesh = ball().mesh()
    for place in PLACES:
        corners = placed(mesh, place).corners - np.asarray(place.offset)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.einsum("nk,nk->n", normals, corners.mean(axis=1)) > 0).all()


def test_meshes_and_copies_come_one_after_the_other() -> None:
    first, second = ball().mesh(), half_dressed_ball().mesh()
    both = scene([(first, (Placement(),)), (second, PLACES[2:])])
    sizes = len(first.faces), len(second.faces)
    assert len(both.faces) == sizes[0] + 2 * sizes[1]
    assert (both.corners[: sizes[0]] == first.corners).all()
    last = both.corners[-sizes[1] :]
    np.testing.assert_allclose(last, placed(second, PLACES[3]).corners)
    assert both.has_uv.sum() == sizes[0] + sizes[1]
    np.testing.assert_allclose(both.corner_uvs[: sizes[0]], first.corner_uvs)
