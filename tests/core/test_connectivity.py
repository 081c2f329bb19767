from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import coo_array, csgraph

from nispcodec.core.connectivity import (
    connected_components,
    connected_faces,
    edge_ids,
    row_ids,
)


@st.composite
def graphs(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, int]:
    size = draw(st.integers(1, 40))
    edges = draw(st.lists(st.tuples(*[st.integers(0, size - 1)] * 2), max_size=60))
    starts, ends = np.array(edges, np.int64).reshape(-1, 2).T
    return starts, ends, size


@given(graphs())
@settings(deadline=None)
def test_components_are_those_of_scipy_in_the_same_order(
    graph: tuple[np.ndarray, np.ndarray, int],
) -> None:
    starts, ends, size = graph
    links = coo_array((np.ones(len(starts), bool), (starts, ends)), shape=(size, size))
    count, labels = csgraph.connected_components(links, directed=False)
    found, ours = connected_components(starts, ends, size)
    assert found == count
    np.testing.assert_array_equal(ours, labels)


@pytest.mark.parametrize("shuffled", [False, True])
def test_a_long_chain_hangs_together(shuffled: bool) -> None:
    nodes = np.arange(100_000)
    if shuffled:
        np.random.default_rng(0).shuffle(nodes)
    count, labels = connected_components(nodes[:-1], nodes[1:], len(nodes))
    assert count == 1
    assert not labels.any()


def test_a_star_round_its_highest_node_hangs_together() -> None:
    rays = np.arange(100_000)
    assert connected_components(rays, np.full(len(rays), len(rays)), len(rays) + 1)[0] == 1


def test_no_edges_and_no_nodes() -> None:
    nothing = np.zeros(0, np.int64)
    assert connected_components(nothing, nothing, 0)[0] == 0
    np.testing.assert_array_equal(connected_components(nothing, nothing, 3)[1], [0, 1, 2])


def test_faces_are_numbered_by_the_first_of_each_patch() -> None:
    faces = np.array([[7, 8, 9], [0, 1, 2], [2, 3, 4], [9, 10, 11]])
    np.testing.assert_array_equal(connected_faces(faces), [0, 1, 1, 0])


def test_equal_rows_get_equal_numbers() -> None:
    np.testing.assert_array_equal(row_ids(np.array([[2, 1], [0, 5], [2, 1]])), [1, 0, 1])


def test_sides_between_the_same_corners_are_one_edge_and_say_which_way_they_run() -> None:
    edge, way = edge_ids(np.array([[0, 1, 2], [2, 1, 3]]))
    assert way.tolist() == [1, 1, -1, -1, 1, -1]
    assert edge[1] == edge[3]
    assert np.bincount(edge).tolist().count(2) == 1
    assert len(np.unique(edge)) == 5
    assert all(len(each) == 0 for each in edge_ids(np.zeros((0, 3), np.int64)))
