"""The generalized winding number: how often a surface, open or not, goes round a point."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import igl
import numpy as np

from nispcodec.core.arrays import Float64Array, IntArray
from nispcodec.core.compiled import KernelError
from nispcodec.geometry.config import WindingConfig
from nispcodec.geometry.z_order import in_space_order
from nispcodec.infer.mesh_tree import MeshTree
from nispcodec.infer.multipoles import multipoles
from nispcodec.infer.native.mesh_kernel import MeshKernel
from nispcodec.infer.parallel import parallel_for

BLOCK = 1 << 13
"""Points that a thread takes at a time."""

_Asked = Callable[[Float64Array, float], Float64Array]
"""The winding numbers (n,) at points (n, 3), clusters as one from so many radii away."""


class Winding:
    """Generalized winding number of vertices (n, 3) and faces (m, 3), by clusters.

    By libigl, or, where it is asked for many more points than there are triangles, by the kernel
    that answers for mesh parts: its tree takes longer to build, and a third of the time to ask.
    """

    def __init__(
        self,
        vertices: Float64Array,
        faces: IntArray,
        config: WindingConfig,
        often: bool = False,
    ) -> None:
        self._vertices, self._faces = vertices, faces
        self._config, self._often = config, often

    @cached_property
    def _tree(self) -> tuple[_Asked, float, float]:
        """What answers, from how many radii away clusters are one, and that for rough answers."""
        config, often = self._config, self._often and len(self._faces)
        kernel = _by_kernel(self._vertices[self._faces]) if often else None
        if kernel:
            return kernel, config.radii, config.rough
        asked = _by_libigl(self._vertices, self._faces)
        return asked, config.libigl_radii, config.libigl_rough

    def forget(self) -> None:
        """Free the tree, which grows again for the next question."""
        vars(self).pop("_tree", None)

    def at(self, points: Float64Array) -> Float64Array:
        """The winding number (n,) at points (n, 3); 0 everywhere where there are no faces."""
        asked, radii, _ = self._tree
        return in_space_order(lambda some: asked(some, radii), points)

    def about(self, points: Float64Array) -> Float64Array:
        """The same, only roughly except near a half, one and a half and so on: which side it is."""
        return in_space_order(self._about, points)

    def _about(self, points: Float64Array) -> Float64Array:
        asked, radii, rough = self._tree
        number = asked(points, rough)
        unclear = np.flatnonzero(np.abs(number - np.floor(number) - 0.5) < self._config.margin)
        number[unclear] = asked(points[unclear], radii)
        return number


def _by_kernel(bodies: Float64Array) -> _Asked | None:
    """None where the kernel was not built, or is not for this processor."""
    tree = MeshTree.of(bodies, np.zeros(len(bodies), np.bool_))
    try:
        kernel = MeshKernel(tree, multipoles(tree))
    except KernelError:
        return None

    def asked(points: Float64Array, radii: float) -> Float64Array:
        numbers = np.empty(len(points))

        def ask(block: slice) -> None:
            numbers[block] = kernel.winding(np.ascontiguousarray(points[block]), radii)

        parallel_for(ask, [slice(at, at + BLOCK) for at in range(0, len(points), BLOCK)])
        return numbers

    return asked


def _by_libigl(vertices: Float64Array, faces: IntArray) -> _Asked:
    tree = igl.FastWindingNumberBVH()
    if len(faces):
        tree.init(vertices, faces.astype(np.int64))

    def asked(points: Float64Array, radii: float) -> Float64Array:
        if not len(faces) or not len(points):
            return np.zeros(len(points))
        numbers: Float64Array = tree.winding_number(points, radii)
        return numbers

    return asked
