"""How often solid triangles go round points, in numpy: where there is no kernel for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.infer.mesh_tree import BRANCHES, MeshTree
from nispcodec.infer.multipoles import far_angles
from nispcodec.infer.triangles import solid_angles


def winding_numbers(
    tree: MeshTree, clusters: Sequence[Float32Array], points: Float64Array, radii: float
) -> Float64Array:
    """(n,) of the solid triangles about points (n, 3).

    Each cluster is taken as one from more than `radii` of its radii away.
    Memory goes with the number of points: callers take blocks.
    """
    columns = np.ascontiguousarray(points.T)
    owner, node = np.arange(len(points)), np.zeros(len(points), np.int64)
    total = np.zeros(len(points))
    for level in clusters:
        rows = level[node].transpose(1, 0, 2)
        angles, squared = far_angles(rows, columns[:, owner][:, :, None])
        far = squared > radii * radii * rows[3]
        total += np.bincount(owner, (angles * far).sum(axis=1), len(points))
        pair, child = np.nonzero(~far)
        owner, node = owner[pair], BRANCHES * node[pair] + child
    triangles = tree.triangles[node].transpose(1, 0, 2)
    angles = solid_angles(triangles, columns[:, owner][:, :, None]) * tree.solid[node]
    total += np.bincount(owner, angles.sum(axis=1), len(points))
    return total / (4 * np.pi)
