from __future__ import annotations

import numpy as np
import pytest

from nispcodec.simplify.meshoptimizer_call import PRUNE, fewer_triangles
from tests.geometry.shapes import grid

CORNERS = grid(8)
POSITIONS, FACES = np.unique(CORNERS.reshape(-1, 3), axis=0, return_inverse=True)
FACES = FACES.reshape(-1, 3)


@pytest.mark.parametrize("options", [0, PRUNE])
def test_a_plane_needs_two_triangles(options: int) -> None:
    found = fewer_triangles(FACES, POSITIONS, POSITIONS[:, :2], 1.0, 2, options)
    assert found.shape == (2, 3)
    corners = POSITIONS[found]
    sides = corners[:, 1:] - corners[:, :1]
    assert np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2 == 4


def test_uvs_that_bend_keep_vertices() -> None:
    bent = POSITIONS[:, :2] + (POSITIONS[:, :1] > 0) * POSITIONS[:, :1] ** 2
    flat, heeded = (
        len(fewer_triangles(FACES, POSITIONS, bent, weight, 40, 0)) for weight in (1e-9, 100.0)
    )
    assert flat <= 40
    assert heeded <= len(FACES)
    moved = POSITIONS[fewer_triangles(FACES, POSITIONS, bent, 100.0, 40, 0)]
    assert np.isin(moved.reshape(-1, 3), POSITIONS).all()


def test_vertices_that_are_kept_stay() -> None:
    kept = np.isclose(np.abs(POSITIONS[:, :2]).max(axis=1), 0.5)
    found = fewer_triangles(FACES, POSITIONS, POSITIONS[:, :2], 1.0, 2, 0, kept)
    assert np.isin(np.flatnonzero(kept), found).all()
