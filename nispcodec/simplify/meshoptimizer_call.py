"""The one call of meshoptimizer: quadric simplification that heeds UVs."""

from __future__ import annotations

import ctypes

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray

PRUNE = 8
"""The library's option to drop bodies that are smaller than the error."""


def fewer_triangles(
    faces: IntArray,
    positions: Float64Array,
    uvs: Float64Array,
    uv_weight: float,
    count: int,
    options: int,
    kept: BoolArray | None = None,
    error: float = 1.0,
) -> Int64Array:
    """About `count` triangles (k, 3), as few as can be had, of vertices that the given ones have.

    There are more where fewer are off by more than `error`, a share of the extent.

    faces (m, 3) into positions (n, 3) and uvs (n, 2); an error of one unit of UV counts as
    `uv_weight` times the extent. kept: (n,), those that stay. Nothing may be left.
    """
    from meshoptimizer import simplify_with_attributes

    _declare()
    indices = np.empty(faces.size, dtype=np.uint32)
    extent = np.ptp(positions, axis=0).max()
    left = simplify_with_attributes(
        indices,
        faces.ravel().astype(np.uint32),
        ((positions - positions.min(axis=0)) / extent).astype(np.float32),
        uvs.astype(np.float32),
        np.full(2, uv_weight, dtype=np.float32),
        target_index_count=3 * count,
        target_error=error,
        vertex_lock=None if kept is None else kept.astype(np.uint8),
        options=options,
    )
    return indices[:left].astype(np.int64).reshape(-1, 3)


def _declare() -> None:
    # The binding forgets to declare this one function: without it, the call crashes.
    from meshoptimizer._loader import lib

    array, size = ctypes.c_void_p, ctypes.c_size_t
    function = lib.meshopt_simplifyWithAttributes
    function.restype = size
    function.argtypes = [
        array, array, size, array, size, size, array, size, array, size,
        array, size, ctypes.c_float, ctypes.c_uint, array,
    ]  # fmt: skip
