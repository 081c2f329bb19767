"""Borders of copies that lie on each other are one surface; others stay where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import fan_normals
from nispcodec.core.mesh_part import Placement
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import triangles_of
from tests.simplify.mirrored import body, both_halves, halved, model_of, parts_of


def normals_of_the_cut(whole: Triangles) -> Float64Array:
    """(k, 3): of all corners of the decoded halves that are in the plane."""
    copies = halved(whole)
    assert copies is not None
    mesh = model_of(parts_of(copies)).to_mesh()
    assert mesh.creases is not None
    rows, fans = fan_normals(row_ids(mesh.positions)[mesh.faces], mesh.corners, mesh.creases)
    found: Float64Array = rows[fans][np.abs(mesh.corners[..., 0]) < 1e-6]
    assert len(found) > 10
    return found


def test_shading_goes_on_over_the_cut() -> None:
    # Both halves have one normal there, which lies in the plane.
    assert np.abs(normals_of_the_cut(body())[:, 0]).max() < 1e-6


def test_shading_breaks_over_a_cut_that_turns_sharply() -> None:
    # A roof, whose ridge is in the plane.
    flat = (shapes.grid(8) + np.array([1, 0, 0])) / 2
    corners = both_halves(flat - flat[..., :1] * [0, 0, 1])
    roof = triangles_of(shapes.soup(corners * 0.7, np.abs(corners[..., :2])))
    assert np.abs(normals_of_the_cut(roof)[:, 0]) == pytest.approx(np.sqrt(0.5), abs=0.02)


def test_borders_that_do_not_meet_stay_where_they_are() -> None:
    copies = halved(body())
    assert copies is not None
    (half,) = parts_of(copies)
    apart = Placement(offset=(0.0, 3.0, 1e-5))
    mesh = model_of((replace(half, placements=(Placement(), apart)),)).to_mesh()
    one, other = np.split(mesh.positions, 2)
    assert one == pytest.approx(half.normalized(), abs=1e-12)
    assert other == pytest.approx(half.normalized() + apart.offset, abs=1e-12)
