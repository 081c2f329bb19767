"""Clusters of triangles as seen from afar: fast winding numbers (Barill et al. 2018)."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.infer.mesh_tree import BRANCHES, MeshTree

ROWS = 13
"""Center of area (3); squared radius about it (1); area vector (3); the six numbers xx, yy, zz, xy,
yz, zx of its second moment, made free of trace (6)."""

NOTHING = -1.0
"""The squared radius of a cluster without a solid triangle: it is far from everywhere."""


def multipoles(tree: MeshTree) -> tuple[Float32Array, ...]:
    """For each level of the tree (nodes, ROWS, BRANCHES): its children's solid triangles as one."""
    corners = tree.triangles[:, :9].transpose(0, 2, 1).reshape(-1, 3, 3)
    sides = corners[:, 1:] - corners[:, :1]
    vectors = np.cross(sides[:, 0], sides[:, 1]) * 0.5 * tree.solid.reshape(-1, 1)
    return tuple(
        _of_level(corners, vectors, BRANCHES ** (len(tree.boxes) - number), len(level))
        for number, level in enumerate(tree.boxes)
    )


def _of_level(corners: Float64Array, vectors: Float64Array, size: int, nodes: int) -> Float32Array:
    """Clusters of `size` consecutive triangles: corners (t, 3, 3), area vectors (t, 3)."""
    starts = np.arange(0, len(corners), size)
    areas, middles = np.linalg.norm(vectors, axis=1), corners.mean(axis=1)
    weights = np.add.reduceat(areas, starts)
    centers = np.add.reduceat(areas[:, None] * middles, starts)
    centers /= np.where(weights > 0, weights, 1)[:, None]
    own = np.repeat(centers, size, axis=0)[: len(corners)]
    off = ((corners - own[:, None]) ** 2).sum(axis=2).max(axis=1) * (areas > 0)
    moments = np.add.reduceat((middles - own)[:, :, None] * vectors[:, None], starts)
    rows = np.zeros((nodes * BRANCHES, ROWS))
    rows[:, 3] = NOTHING
    rows[: len(starts)] = np.concatenate(
        [
            centers,
            np.where(weights > 0, np.maximum.reduceat(off, starts), NOTHING)[:, None],
            np.add.reduceat(vectors, starts),
            _without_trace(moments),
        ],
        axis=1,
    )
    return np.ascontiguousarray(
        rows.reshape(nodes, BRANCHES, ROWS).transpose(0, 2, 1).astype(np.float32)
    )


def _without_trace(moments: Float64Array) -> Float64Array:
    """(n, 6) of trace(M) - 3 M, made symmetric, for M (n, 3, 3)."""
    trace = np.trace(moments, axis1=1, axis2=2)[:, None]
    diagonal = trace - 3 * np.diagonal(moments, axis1=1, axis2=2)
    both = -1.5 * (moments + moments.swapaxes(1, 2))
    return np.concatenate([diagonal, both[:, [0, 1, 2], [1, 2, 0]]], axis=1)


def far_angles(
    rows: Float32Array | Float64Array, points: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Solid angles (...) of clusters (ROWS, ...) from points (3, ...); the squared distances.

    That is the dipole and the quadrupole, the first two terms of a Taylor series around the center.
    """
    x, y, z = rows[0:3] - points
    squared = x * x + y * y + z * z
    inverse = 1 / np.maximum(squared, TINY)
    dipole = x * rows[4] + y * rows[5] + z * rows[6]
    quadrupole = x * x * rows[7] + y * y * rows[8] + z * z * rows[9]
    quadrupole += 2 * (x * y * rows[10] + y * z * rows[11] + z * x * rows[12])
    angles: Float64Array = (dipole + quadrupole * inverse) * inverse * np.sqrt(inverse)
    return angles, squared


TINY = 1e-30
