"""Equal rows of tables, and what of a mesh hangs together through them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

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


def connected_faces(corners: Int64Array) -> Int32Array:
    """(m, 3) corner numbers from 0 up -> (m,) int32: faces that corners connect share a number.

    Numbers rise with the first face that has each.
    """
    faces = len(corners)
    rows = np.repeat(np.arange(faces), 3)
    columns = faces + corners.reshape(-1)
    size = faces + int(corners.max()) + 1
    graph = coo_matrix((np.ones(3 * faces, dtype=bool), (rows, columns)), shape=(size, size))
    labels = connected_components(graph, directed=False)[1][:faces]
    return _numbered_by_first(labels)


def _numbered_by_first(labels: IntArray) -> Int32Array:
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    numbered: Int32Array = rank[inverse.reshape(-1)]
    return numbered
