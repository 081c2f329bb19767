"""Closest triangles and insides of a mesh, for any number of points, on every core."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, FloatArray, IndexArray, Int32Array
from nispcodec.core.compiled import KernelError
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import multipoles
from nispcodec.infer.native.mesh_kernel import MeshKernel
from nispcodec.infer.numpy_mesh import NumpyMesh
from nispcodec.infer.parallel import parallel_for
from nispcodec.infer.space_order import space_order


@dataclass(frozen=True)
class SearchConfig:
    """How searches go about it.

    kernel  whether the compiled kernel is used where there is one
    block   points at a time: enough that threads have little to hand out
    large   a mesh of more triangles is not in a processor's cache all at once: points are asked
            in an order in which neighbors follow each other, which takes 90 ns a point and saves
            180,000 triangles half of the time or more, 5,000 as much as it takes
    more    points at a time then
    small   points at a time in numpy: its arrays for so many fit into a processor's own cache
    rough   radii of a cluster away from which on it is taken as one (Barill et al. 2018), at first:
            winding numbers are wrong by up to 0.13 on the meshes tried
    margin  ... so that those so near to 1/2 are taken again
    exact   with these radii, which leave an error below 5e-3
    """

    kernel: bool = True
    block: int = 4096
    large: int = 20_000
    more: int = 16_384
    small: int = 128
    rough: float = 1.25
    margin: float = 0.3
    exact: float = 6.0


class MeshSearch:
    """Triangles (f, 3, 3) float64, any f, to be asked; those of sheets (f,) bool have no inside.

    Points (n, 3) are float32 or float64, in the triangles' frame.
    """

    def __init__(
        self, corners: Float64Array, sheet: BoolArray, config: SearchConfig = SearchConfig()
    ) -> None:
        self._config = config
        self._large = len(corners) > config.large
        self._solid = bool((~sheet).any())
        self._engine = _engine(corners, sheet, config) if len(corners) else None

    def closest(self, points: FloatArray) -> tuple[Int32Array, Float64Array]:
        """The closest face (n,) and its squared distance (n,); 0 and infinity without triangles."""
        faces = np.zeros(len(points), np.int32)
        squared = np.full(len(points), np.inf)
        engine = self._engine
        if engine is None:
            return faces, squared

        def search(block: slice) -> None:
            order = self._order(points[block])
            found = engine.closest(_exact(points[block][order]))
            faces[block][order], squared[block][order] = found

        self._in_blocks(search, len(points))
        return faces, squared

    def inside(self, points: FloatArray) -> BoolArray:
        """(n,) whether the winding number of the solid triangles is over 1/2 or under -1/2."""
        inside = np.zeros(len(points), np.bool_)
        engine, config = self._engine, self._config
        if engine is None or not self._solid:
            return inside

        def search(block: slice) -> None:
            order = self._order(points[block])
            asked = _exact(points[block][order])
            inside[block][order] = engine.inside(asked, config.rough, config.margin, config.exact)

        self._in_blocks(search, len(points))
        return inside

    def _order(self, points: FloatArray) -> IndexArray | slice:
        """How a block of points (n, 3) is asked."""
        return space_order(points) if self._large else slice(None)

    def _in_blocks(self, run: Callable[[slice], None], count: int) -> None:
        size = self._config.more if self._large else self._config.block
        if not isinstance(self._engine, MeshKernel):
            size = self._config.small
        parallel_for(run, [slice(start, start + size) for start in range(0, count, size)])


class _Engine(Protocol):
    """What searches a block of points (n, 3) float64."""

    def closest(self, points: Float64Array) -> tuple[Int32Array, Float64Array]: ...

    def inside(
        self, points: Float64Array, rough: float, margin: float, exact: float
    ) -> BoolArray: ...


def _engine(corners: Float64Array, sheet: BoolArray, config: SearchConfig) -> _Engine:
    tree = MeshTree.of(corners, sheet)
    clusters = multipoles(tree)
    if config.kernel:
        try:
            return MeshKernel(tree, clusters)
        except KernelError:
            # Not built, or not for this processor: slower, but the same answers.
            pass
    return NumpyMesh(tree, clusters)


def _exact(points: FloatArray) -> Float64Array:
    return np.ascontiguousarray(points, np.float64)
