"""A tree of triangles, searched by the compiled kernel."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Float32Array, Float64Array, Int32Array
from nispcodec.core.compiled import CompiledKernel
from nispcodec.infer.mesh_tree import MeshTree

MOST_LEVELS = 12
_P, _L, _D = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double

KERNEL = CompiledKernel(
    folder=Path(__file__).parent,
    interface=1,
    signatures=(
        ("nisp_best_level", ctypes.c_int32, ()),
        ("nisp_closest", None, (_P, _P, _L, _P, _P)),
        ("nisp_inside", None, (_P, _P, _L, _D, _D, _D, _P)),
        ("nisp_winding", None, (_P, _P, _L, _D, _P)),
    ),
)


class _Tree(ctypes.Structure):
    """`nisp::Tree` of kernel/tree.h."""

    _fields_ = (
        ("levels", ctypes.c_int32),
        ("boxes", ctypes.c_void_p * MOST_LEVELS),
        ("clusters", ctypes.c_void_p * MOST_LEVELS),
        ("triangles", ctypes.c_void_p),
        ("faces", ctypes.c_void_p),
        ("solid", ctypes.c_void_p),
    )


class MeshKernel:
    """The searches of `closest_triangle` and `winding_number` on a tree and its clusters.

    Clusters are those of `multipoles`, or none, and then nothing is asked but what is closest.
    Points (n, 3) are float64 in C order. Raises KernelError where there is no kernel.
    """

    def __init__(
        self, tree: MeshTree, clusters: Sequence[Float32Array], isa: str | None = None
    ) -> None:
        self._functions = KERNEL.best() if isa is None else KERNEL.load(isa)
        solid = tree.solid.astype(np.float32)
        # Kept, as the kernel reads them where they are.
        self._arrays = (tree, tuple(clusters), solid)
        self._tree = _Tree(
            levels=len(tree.boxes),
            boxes=(ctypes.c_void_p * MOST_LEVELS)(*(each.ctypes.data for each in tree.boxes)),
            clusters=(ctypes.c_void_p * MOST_LEVELS)(*(each.ctypes.data for each in clusters)),
            triangles=tree.triangles.ctypes.data,
            faces=tree.faces.ctypes.data,
            solid=solid.ctypes.data,
        )

    def closest(self, points: Float64Array) -> tuple[Int32Array, Float64Array]:
        """The closest face (n,) and its squared distance (n,), as `closest_triangles`."""
        faces = np.empty(len(points), np.int32)
        squared = np.empty(len(points))
        self._functions.nisp_closest(*self._asked(points), _at(faces), _at(squared))
        return faces, squared

    def inside(self, points: Float64Array, rough: float, margin: float, exact: float) -> BoolArray:
        """(n,) whether the winding number is over 1/2 or under -1/2.

        It is taken with `rough` radii, and again with `exact` ones where it is not `margin` away
        from that.
        """
        inside = np.empty(len(points), np.bool_)
        self._functions.nisp_inside(*self._asked(points), rough, margin, exact, _at(inside))
        return inside

    def winding(self, points: Float64Array, radii: float) -> Float64Array:
        """(n,) winding numbers, as `winding_numbers`."""
        numbers = np.empty(len(points))
        self._functions.nisp_winding(*self._asked(points), radii, _at(numbers))
        return numbers

    def _asked(self, points: Float64Array) -> tuple[object, ...]:
        """What every function begins with."""
        assert points.dtype == np.float64
        assert points.flags.c_contiguous
        assert points.shape[1:] == (3,)
        return ctypes.byref(self._tree), _at(points), len(points)


def _at(array: AnyArray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
