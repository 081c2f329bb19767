"""Surfaces that touch themselves become manifold, and lose nothing."""

from __future__ import annotations

import numpy as np

from nispcodec.extract.components import components
from nispcodec.extract.config import SimplifyConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.manifold import manifold
from tests.extract.surfaces import areas, assert_closed

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


def surface(positions: np.ndarray, faces: np.ndarray) -> Surface:
    return Surface(positions.astype(np.float32), faces.astype(np.int32), 0.1)


def test_what_is_manifold_stays_as_it_is() -> None:
    given = surface(CORNERS, TETRAHEDRON)
    done = manifold(given)
    assert np.array_equal(done.positions, given.positions)
    assert np.array_equal(done.faces, given.faces)


def test_two_bodies_at_one_edge_come_apart() -> None:
    # The second tetrahedron is the first one turned by half round the edge along x.
    turned = CORNERS * [1, -1, -1]
    positions = np.vstack([CORNERS, turned[2:]])
    other = np.array([0, 1, 4, 5])[TETRAHEDRON]
    touching = surface(positions, np.vstack([TETRAHEDRON, other]))
    done = manifold(touching)
    assert_closed(done.faces)
    assert components(done)[0] == 2
    assert len(np.unique(done.positions, axis=0)) == 8
    reach = np.abs(done.positions[done.faces] - touching.positions[touching.faces])
    assert 0 < reach.max() <= SimplifyConfig.retreat


def test_two_bodies_at_one_vertex_come_apart() -> None:
    positions = np.vstack([CORNERS, -CORNERS[1:]])
    other = np.array([0, 4, 5, 6])[TETRAHEDRON][:, ::-1]
    done = manifold(surface(positions, np.vstack([TETRAHEDRON, other])))
    assert_closed(done.faces)
    assert components(done)[0] == 2
    assert len(done.positions) == 8


def test_a_tunnel_pinched_shut_gets_two_edges() -> None:
    # A ring of three by four vertices; two of the three along its inside become one.
    turn, tube = np.meshgrid(np.arange(3), np.arange(4), indexing="ij")
    radius, angle = 1 + 0.5 * np.cos(tube * np.pi / 2), turn * 2 * np.pi / 3
    height = 0.5 * np.sin(tube * np.pi / 2)
    positions = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], -1)
    a, b = 4 * turn + tube, 4 * ((turn + 1) % 3) + tube
    c, d = 4 * ((turn + 1) % 3) + (tube + 1) % 4, 4 * turn + (tube + 1) % 4
    faces = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    assert_closed(faces)
    welded = np.where(faces == 6, 2, faces)
    kept = welded[(welded != np.roll(welded, 1, axis=1)).all(axis=1)]
    positions[0, 2] = (positions[0, 2] + positions[1, 2]) / 2
    pinched = surface(positions.reshape(-1, 3), kept)
    done = manifold(pinched)
    assert_closed(done.faces)
    assert len(done.faces) == len(kept) + 4
    before, after = (areas(each.positions, each.faces).sum() for each in (pinched, done))
    np.testing.assert_allclose(after, before, rtol=2 * SimplifyConfig.retreat)


def test_a_surface_with_an_edge_keeps_it() -> None:
    """As where a field has no end: the surface stops at the grid's."""
    for missing in (1, 2, 3):
        given = surface(CORNERS, TETRAHEDRON[missing:])
        done = manifold(given)
        assert np.array_equal(done.positions[done.faces], given.positions[given.faces])


def test_bodies_at_one_edge_come_apart_though_one_is_open() -> None:
    turned = CORNERS * [1, -1, -1]
    positions = np.vstack([CORNERS, turned[2:]])
    other = np.array([0, 1, 4, 5])[TETRAHEDRON]
    done = manifold(surface(positions, np.vstack([TETRAHEDRON, other[1:]])))
    assert components(done)[0] == 2
    assert len(done.faces) == 7
