"""A tree of triangles, searched by numpy where there is no kernel for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array, Int32Array
from nispcodec.infer.closest_triangle import closest_triangles
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.winding_number import winding_numbers


class NumpyMesh:
    """As `MeshKernel`, many times slower."""

    def __init__(self, tree: MeshTree, clusters: Sequence[Float32Array]) -> None:
        self._tree, self._clusters = tree, clusters

    def closest(self, points: Float64Array) -> tuple[Int32Array, Float64Array]:
        """The closest face (n,) and its squared distance (n,)."""
        return closest_triangles(self._tree, points)

    def inside(self, points: Float64Array, rough: float, margin: float, exact: float) -> BoolArray:
        """(n,) whether the winding number is over 1/2 or under -1/2."""
        numbers = self._over(points, rough)
        unclear = np.flatnonzero(np.abs(numbers) < margin)
        numbers[unclear] = self._over(points[unclear], exact)
        return numbers > 0

    def _over(self, points: Float64Array, radii: float) -> Float64Array:
        """How far over 1/2 the winding number is."""
        return np.abs(winding_numbers(self._tree, self._clusters, points, radii)) - 0.5
