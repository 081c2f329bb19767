"""Quadric simplification that heeds UVs: meshoptimizer (Garland and Heckbert 1998, Hoppe 1999)."""

from __future__ import annotations

import ctypes

import numpy as np

from benchmarks.assets.corners import Corners

# On chess_king, 0.3 to 3 changed bytes by 2 % and distances by 8 %, up and down: one is enough.
UV_WEIGHT = 1.0
# Drop bodies smaller than the error: without it no curve goes below the smallest of each body.
PRUNE = 8


def simplified(corners: Corners, faces: int) -> Corners:
    """About `faces` triangles, as few as can be had; vertices are a subset of the given ones.

    Raises ValueError when nothing is left: bodies smaller than the error are dropped.
    """
    from meshoptimizer import simplify_with_attributes

    _declare()
    indices = np.empty(corners.faces.size, dtype=np.uint32)
    extent = np.ptp(corners.positions, axis=0).max()
    positions = (corners.positions - corners.positions.min(axis=0)) / extent
    count = simplify_with_attributes(
        indices,
        corners.faces.ravel(),
        positions.astype(np.float32),
        corners.uvs.astype(np.float32),
        np.full(2, UV_WEIGHT, dtype=np.float32),
        target_index_count=3 * faces,
        target_error=1.0,
        options=PRUNE,
    )
    if count == 0:
        raise ValueError(f"expected about {faces} of {len(corners.faces)} faces, found none left")
    return corners.only(indices[:count])


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
