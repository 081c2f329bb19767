"""The triangle that is closest to each point, in numpy: where there is no kernel for it."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, Int32Array, IntArray
from nispcodec.infer.mesh_tree import BRANCHES, MeshTree
from nispcodec.infer.triangles import squared_distances


def closest_triangles(tree: MeshTree, points: Float64Array) -> tuple[Int32Array, Float64Array]:
    """The closest face (n,) to points (n, 3), and the squared distance (n,).

    Of triangles equally near it is that of the lowest number. Memory goes with the number of
    points: callers take blocks.
    """
    columns = np.ascontiguousarray(points.T)
    everyone = np.arange(len(points))
    squared, faces = _in_leaves(tree, columns, everyone, _near_leaves(tree, columns))
    owner, leaf = _leaves_within(tree, columns, widened(squared, columns))
    other_squared, other_faces = _in_leaves(tree, columns, owner, leaf)
    owners = np.concatenate([everyone, owner])
    squared = np.concatenate([squared, other_squared])
    order = np.lexsort((np.concatenate([faces, other_faces]), squared, owners))
    chosen = order[np.diff(owners[order], prepend=-1) > 0]
    return np.concatenate([faces, other_faces])[chosen], squared[chosen]


def widened(squared: Float64Array, columns: Float64Array) -> Float64Array:
    """Squared distances (n,), a little more: so much may rounding at points (3, n) have taken."""
    slack = ROUNDING * (1 + np.abs(columns).max(axis=0))
    wide: Float64Array = (np.sqrt(squared) + slack) ** 2
    return wide


ROUNDING = 1e-14


def _near_leaves(tree: MeshTree, columns: Float64Array) -> IntArray:
    """(n,) a leaf near each point (3, n): down the tree by whichever box is nearest."""
    node = np.zeros(columns.shape[1], np.int64)
    for boxes in tree.boxes:
        node = BRANCHES * node + _box_distances(boxes[node], columns).argmin(axis=1)
    return node


def _leaves_within(
    tree: MeshTree, columns: Float64Array, reach: Float64Array
) -> tuple[IntArray, IntArray]:
    """Pairs of a point (3, n) and a leaf whose box is nearer than the square root of `reach`."""
    owner, node = np.arange(columns.shape[1]), np.zeros(columns.shape[1], np.int64)
    for boxes in tree.boxes:
        bounds = _box_distances(boxes[node], columns[:, owner])
        pair, child = np.nonzero(bounds < reach[owner][:, None])
        owner, node = owner[pair], BRANCHES * node[pair] + child
    return owner, node


def _box_distances(boxes: Float64Array, columns: Float64Array) -> Float64Array:
    """Squared distances of points (3, n) from boxes (n, 6, BRANCHES): (n, BRANCHES)."""
    squared = np.zeros((len(boxes), BRANCHES))
    for axis in range(3):
        along = columns[axis][:, None]
        off = np.maximum(np.maximum(boxes[:, axis] - along, along - boxes[:, 3 + axis]), 0)
        squared += off * off
    return squared


def _in_leaves(
    tree: MeshTree, columns: Float64Array, owner: IntArray, leaf: IntArray
) -> tuple[Float64Array, Int32Array]:
    """For pairs of point and leaf the least squared distance and its face, the lowest of equals."""
    rows = tree.triangles[leaf].transpose(1, 0, 2)
    squared = squared_distances(rows, columns[:, owner][:, :, None])
    least = squared.min(axis=1)
    faces = np.where(squared == least[:, None], tree.faces[leaf], np.iinfo(np.int32).max)
    return least, faces.min(axis=1)
