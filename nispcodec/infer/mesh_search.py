"""Closest triangles and insides of a mesh, for any number of points, on every core."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, Int32Array
from nispcodec.infer.closest_triangle import closest_triangles
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import multipoles
from nispcodec.infer.parallel import parallel_for
from nispcodec.infer.winding_number import winding_numbers


@dataclass(frozen=True)
class SearchConfig:
    """How searches go about it.

    block   points at a time: what numpy holds for them fits into the processor's cache
    rough   radii of a cluster away from which on it is taken as one (Barill et al. 2018), at first
    margin  how near to 1/2 a winding number found so is not trusted: three times its error on the
            meshes tried
    exact   radii then: errors are below 1e-3
    """

    block: int = 1024
    rough: float = 2.0
    margin: float = 0.15
    exact: float = 6.0


class MeshSearch:
    """Of triangles (f, 3, 3) float64, any f; those of sheets (f,) bool have no inside.

    Points (n, 3) are float32 or float64, in the triangles' frame.
    """

    def __init__(
        self, corners: Float64Array, sheet: BoolArray, config: SearchConfig = SearchConfig()
    ) -> None:
        self._config = config
        self._tree = MeshTree.of(corners, sheet) if len(corners) else None
        self._solid = bool((~sheet).any())
        self._clusters = multipoles(self._tree) if self._tree and self._solid else ()
        self.face_normals = _unit_normals(corners)

    def closest(self, points: FloatArray) -> tuple[Int32Array, Float64Array]:
        """The closest face (n,) and its squared distance (n,); 0 and infinity without triangles."""
        faces = np.zeros(len(points), np.int32)
        squared = np.full(len(points), np.inf)
        tree = self._tree

        def search(block: slice) -> None:
            assert tree is not None
            faces[block], squared[block] = closest_triangles(tree, _exact(points[block]))

        if tree is not None:
            self._in_blocks(search, len(points))
        return faces, squared

    def inside(self, points: FloatArray) -> BoolArray:
        """(n,) whether the winding number of the solid triangles is over 1/2 or under -1/2."""
        inside = np.zeros(len(points), np.bool_)

        def search(block: slice) -> None:
            inside[block] = self._inside(_exact(points[block]))

        if self._clusters:
            self._in_blocks(search, len(points))
        return inside

    def _inside(self, points: Float64Array) -> BoolArray:
        numbers = np.abs(self._winding(points, self._config.rough))
        unclear = np.flatnonzero(np.abs(numbers - 0.5) < self._config.margin)
        numbers[unclear] = np.abs(self._winding(points[unclear], self._config.exact))
        return numbers > 0.5

    def _winding(self, points: Float64Array, radii: float) -> Float64Array:
        assert self._tree is not None
        return winding_numbers(self._tree, self._clusters, points, radii)

    def _in_blocks(self, run: Callable[[slice], None], count: int) -> None:
        size = self._config.block
        parallel_for(run, [slice(start, start + size) for start in range(0, count, size)])


def _exact(points: FloatArray) -> Float64Array:
    return np.ascontiguousarray(points, np.float64)


def _unit_normals(corners: Float64Array) -> Float64Array:
    """(f, 3) of triangles (f, 3, 3); 0 where there is no area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    units: Float64Array = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    return units
