"""Every node is visited once, and what it is predicted from is known by then."""

from __future__ import annotations

from hypothesis import given

from nispcodec.core.mesh_part import MeshPart
from nispcodec.format.mesh import manifold
from nispcodec.format.mesh.order import HINGES, visits
from tests.format.mesh.parts import grid, parts


@given(parts())
def test_each_once_and_only_from_known_ones(made: MeshPart) -> None:
    corners = made.faces.ravel().tolist()
    twin = manifold.twins(made.faces, made.sheet, lambda one, other: 0).tolist()
    count = max(corners) + 1
    known: set[int] = set()
    for node, hinges, near in visits(corners, twin, [False] * count):
        assert node not in known
        used = {each for hinge in hinges for each in hinge} | {near}
        assert used <= known | {-1}
        assert len(hinges) <= HINGES
        assert not (hinges and any(-1 in hinge[:2] for hinge in hinges))
        known.add(node)
    assert known == set(corners)


def test_in_a_grid_most_are_predicted_from_two_faces() -> None:
    flat = grid(10)
    twin = manifold.twins(flat.faces, flat.sheet, lambda one, other: 0).tolist()
    counts = [
        len(hinges) for _, hinges, _ in visits(flat.faces.ravel().tolist(), twin, [False] * 121)
    ]
    assert sum(count >= 2 for count in counts) > 80
