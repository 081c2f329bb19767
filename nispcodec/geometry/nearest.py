"""The closest of many triangles to points, and where on it: by our kernel, or else by libigl."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import igl
import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array, IntArray
from nispcodec.core.compiled import KernelError
from nispcodec.geometry.triangles import apart
from nispcodec.geometry.z_order import z_order
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.native.mesh_kernel import MeshKernel
from nispcodec.infer.parallel import parallel_for
from nispcodec.infer.triangles import closest_weights, triangle_rows

BLOCK = 1 << 13
"""Points that a thread takes at a time: their arrays fit into a processor's own cache."""


@dataclass(frozen=True)
class Nearest:
    """The closest points of triangles to n points.

    faces      (n,) int64: whose they are
    distances  (n,)
    weights    (n, 3): barycentric
    positions  (n, 3)
    """

    faces: Int64Array
    distances: Float64Array
    weights: Float64Array
    positions: Float64Array


class NearestTriangles:
    """Triangles (m, 3, 3) float64, at least one, to be asked what of them is closest to points."""

    def __init__(self, corners: Float64Array) -> None:
        self._corners = corners
        self._faces = _faces_by_kernel(corners) or _faces_by_libigl(corners)

    def closest(self, points: Float64Array) -> Nearest:
        """The closest points to points (n, 3), which are in any order, on every core."""
        found = Nearest(
            np.empty(len(points), np.int64),
            np.empty(len(points)),
            np.empty((len(points), 3)),
            np.empty((len(points), 3)),
        )
        order = z_order(points)

        def ask(block: slice) -> None:
            self._ask(points, order[block], found)

        parallel_for(ask, [slice(at, at + BLOCK) for at in range(0, len(points), BLOCK)])
        return found

    def _ask(self, points: Float64Array, chosen: Int64Array, found: Nearest) -> None:
        """Fill in what is closest to the chosen (k,) of the points."""
        asked = np.ascontiguousarray(points[chosen], np.float64)
        faces = self._faces(asked)
        corners = self._corners[faces]
        weights = closest_weights(triangle_rows(corners), asked.T).T
        positions = np.einsum("nk,nkd->nd", weights, corners)
        away = asked - positions
        found.faces[chosen], found.weights[chosen] = faces, weights
        found.positions[chosen] = positions
        found.distances[chosen] = np.sqrt(np.einsum("nd,nd->n", away, away))


_Faces = Callable[[Float64Array], IntArray]
"""The numbers (n,) of the triangles closest to points (n, 3)."""


def _faces_by_kernel(corners: Float64Array) -> _Faces | None:
    """None where the kernel was not built, or is not for this processor."""
    tree = MeshTree.of(corners, np.ones(len(corners), np.bool_))
    try:
        kernel = MeshKernel(tree, ())
    except KernelError:
        return None
    return lambda points: kernel.closest(points)[0]


def _faces_by_libigl(corners: Float64Array) -> _Faces:
    vertices, faces = apart(corners)
    tree = igl.AABB()
    tree.init(vertices, faces)
    return lambda points: np.atleast_1d(tree.squared_distance(vertices, faces, points)[1])
