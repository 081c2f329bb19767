"""Equal rows of tables, and what of a graph or a mesh hangs together."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray, Int32Array, Int64Array, IntArray


def row_ids(rows: AnyArray) -> Int64Array:
    """(n, c) numbers -> (n,) int64: equal rows get equal numbers from 0 up, without gaps."""
    if not len(rows):
        return np.zeros(0, dtype=np.int64)
    # Several times as fast as np.unique over an axis.
    order = np.lexsort(rows.T[::-1])
    is_new = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    ids = np.zeros(len(rows), dtype=np.int64)
    ids[order[1:]] = np.cumsum(is_new)
    return ids


def cell_ids(*tables: AnyArray) -> Int64Array:
    """Tables (n, c) or (n, 1) -> (n, c) int64: cells equal in all tables get equal numbers.

    Numbers count from 0 up, without gaps.
    """
    stacked = np.stack(np.broadcast_arrays(*tables), axis=2)
    return row_ids(stacked.reshape(-1, len(tables))).reshape(stacked.shape[:2])


def edge_ids(corners: Int64Array) -> tuple[Int64Array, Int64Array]:
    """(m, 3) corner numbers from 0 up -> of the 3 m sides of faces, edge and way (3 m,) int64.

    Sides run from each corner to the next; those between the same two corners, either way, are of
    one edge, numbered from 0 up. The way is 1 from the lower to the higher number, -1 back.
    """
    if not len(corners):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    start, end = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    low, high = np.minimum(start, end), np.maximum(start, end)
    _, edge = np.unique(low * (int(corners.max()) + 1) + high, return_inverse=True)
    return edge.reshape(-1), np.where(start < end, 1, -1)


def connected_faces(corners: Int64Array) -> Int32Array:
    """(m, 3) corner numbers from 0 up -> (m,) int32: faces that corners connect share a number.

    Numbers rise with the first face that has each.
    """
    labels = connected_components(corners[:, :2], corners[:, 1:], int(corners.max()) + 1)[1]
    return _numbered_by_first(labels[corners[:, 0]])


def connected_components(starts: IntArray, ends: IntArray, size: int) -> tuple[int, Int32Array]:
    """How many components the graph of nodes 0 to size - 1 has, and the component of each node.

    starts, ends: the nodes at either end of each edge, two arrays of one shape, in any order
    -> count, labels (size,) int32. Components are numbered by their lowest nodes, as scipy does.
    """
    # Every node points at a lower one of its component, or at itself (Liu and Tarjan, "Simple
    # Concurrent Labeling Algorithms for Connected Components", 2019). A round follows all pointers
    # to their roots, and points each root at the lowest of those that an edge leads to.
    parents = np.arange(size, dtype=np.int32)
    starts, ends = starts.astype(np.int32).ravel(), ends.astype(np.int32).ravel()
    while len(starts):
        low, high = np.minimum(starts, ends), np.maximum(starts, ends)
        np.minimum.at(parents, high, low)
        parents = _roots(parents)
        starts, ends = parents[low], parents[high]
        apart = starts != ends
        starts, ends = starts[apart], ends[apart]
    is_root = parents == np.arange(size, dtype=np.int32)
    numbers = np.cumsum(is_root, dtype=np.int32) - np.int32(1)
    return int(is_root.sum()), numbers[parents]


def _roots(parents: Int32Array) -> Int32Array:
    """Where each node comes to (n,) that follows parents up to the end."""
    while True:
        further = parents[parents]
        if np.array_equal(further, parents):
            return parents
        parents = further


def _numbered_by_first(labels: IntArray) -> Int32Array:
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    numbered: Int32Array = rank[inverse.reshape(-1)]
    return numbered
