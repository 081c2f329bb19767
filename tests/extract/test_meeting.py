"""Borders of copies that lie on each other are one surface; others stay where they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.connectivity import row_ids
from nispcodec.core.creases import fan_normals
from nispcodec.core.mesh_part import Placement
from tests.geometry import shapes
from tests.simplify.meshes import triangles_of
from tests.simplify.mirrored import body, both_halves, halved, model_of, parts_of


def test_shading_goes_on_over_the_cut() -> None:
    whole = body()
    copies = halved(whole)
    assert copies is not None
    mesh = model_of(parts_of(copies)).to_mesh()
    assert mesh.creases is not None
    rows, fans = fan_normals(row_ids(mesh.positions)[mesh.faces], mesh.corners, mesh.creases)
    on_plane = np.abs(mesh.corners[..., 0]) < 1e-6
    assert on_plane.sum() > 20
    # Both halves have one normal there, which lies in the plane.
    assert np.abs(rows[fans][on_plane][:, 0]).max() < 1e-6


def test_shading_breaks_over_a_cut_that_turns_sharply() -> None:
    # A roof, whose ridge is in the plane.
    flat = (shapes.grid(8) + np.array([1, 0, 0])) / 2
    corners = both_halves(flat - flat[..., :1] * [0, 0, 1])
    bent, uvs = corners * 0.7, np.abs(corners[..., :2])
    copies = halved(triangles_of(shapes.soup(bent, uvs)))
    assert copies is not None
    mesh = model_of(parts_of(copies)).to_mesh()
    assert mesh.creases is not None
    rows, fans = fan_normals(row_ids(mesh.positions)[mesh.faces], mesh.corners, mesh.creases)
    ridge = np.abs(mesh.corners[..., 0]) < 1e-6
    assert ridge.sum() > 10
    assert np.abs(rows[fans][ridge][:, 0]) == pytest.approx(np.sqrt(0.5), abs=0.02)


def test_borders_that_do_not_meet_stay_where_they_are() -> None:
    copies = halved(body())
    assert copies is not None
    (half,) = parts_of(copies)
    apart = Placement(offset=(0.0, 3.0, 1e-5))
    mesh = model_of((replace(half, placements=(Placement(), apart)),)).to_mesh()
    one, other = np.split(mesh.positions, 2)
    assert one == pytest.approx(half.normalized(), abs=1e-12)
    assert other == pytest.approx(half.normalized() + apart.offset, abs=1e-12)
