"""Error radii of hard examples by a grid of cells, which is built once for all minings."""

from __future__ import annotations

import weakref

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.train.backend.native.library import NativeError, checked, library, pointer


class NearestGrid:
    """The cells that points (n, 3) float32 lie in; they are copied.

    Raises NativeError where there is no native backend, ValueError for points that are not finite.
    """

    def __init__(self, points: Float32Array, isa: str | None = None) -> None:
        checked("points", points, np.float32, None, 3)
        if not len(points) or not np.isfinite(points).all():
            raise ValueError(f"points: expected some, all finite, found {len(points)} points")
        self._functions, self._count = library(isa).functions, len(points)
        self._grid = self._functions.nisp_grid_new(pointer(points), len(points))
        if not self._grid:
            raise NativeError("the nearest grid: out of memory")
        # Not when Python ends: a fit's thread may still be searching it.
        weakref.finalize(self, self._functions.nisp_grid_free, self._grid).atexit = False

    def error_radii(
        self, sdf: Float32Array, field: Float32Array, limit: float, floaters: bool = False
    ) -> Float32Array:
        """The same (n,) as `nispcodec.dataset.hard_examples.error_radii`, which explains them.

        sdf and field are (n,) float32. Raises ValueError if they are not, or `limit` is no
        distance, NativeError without memory.
        """
        checked("sdf", sdf, np.float32, self._count)
        checked("field", field, np.float32, self._count)
        if not 0 <= limit < np.inf:
            raise ValueError(f"limit: expected a distance, found {limit}")
        radii = np.empty(self._count, dtype=np.float32)
        told = (pointer(sdf), pointer(field), limit, floaters, pointer(radii))
        if not self._functions.nisp_error_radii(self._grid, *told):
            raise NativeError("error radii: out of memory")
        return radii
