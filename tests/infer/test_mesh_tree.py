from __future__ import annotations

import numpy as np
import pytest

from nispcodec.infer.mesh_tree import BRANCHES, MeshTree
from nispcodec.infer.triangles import ROWS
from tests.infer.parts import soup


@pytest.mark.parametrize("count", [1, 7, 8, 9, 64, 65, 700])
def test_every_triangle_is_in_one_leaf_and_in_the_boxes_above(count: int) -> None:
    corners = soup(count)
    sheet = np.arange(count) % 3 == 0
    tree = MeshTree.of(corners, sheet)
    leaves = len(tree.faces)
    assert tree.triangles.shape == (leaves, ROWS, BRANCHES)
    assert set(tree.faces.ravel().tolist()) == set(range(count))
    assert sorted(tree.faces[tree.solid].tolist()) == np.flatnonzero(~sheet).tolist()
    for number, boxes in enumerate(tree.boxes):
        size = BRANCHES ** (len(tree.boxes) - number - 1)
        for leaf in np.flatnonzero(tree.solid.any(axis=1)):
            node, child = divmod(leaf // size, BRANCHES)
            inside = corners[tree.faces[leaf]].reshape(-1, 3)
            assert (inside >= boxes[node, :3, child]).all()
            assert (inside <= boxes[node, 3:, child]).all()


def test_each_level_has_a_node_for_every_child_of_the_one_before() -> None:
    tree = MeshTree.of(soup(700), np.zeros(700, np.bool_))
    sizes = [len(boxes) for boxes in tree.boxes]
    assert sizes[0] == 1
    for above, below in zip(sizes, [*sizes[1:], len(tree.faces)], strict=True):
        assert below <= BRANCHES * above < below + BRANCHES


def test_triangles_in_one_place_are_divided_too() -> None:
    tree = MeshTree.of(np.repeat(soup(1), 100, axis=0), np.zeros(100, np.bool_))
    assert set(tree.faces.ravel().tolist()) == set(range(100))
