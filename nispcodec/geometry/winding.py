"""The generalized winding number: how often a surface, open or not, goes round a point."""

from __future__ import annotations

from functools import partial

import igl
import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.geometry.z_order import in_space_order


class Winding:
    """Generalized winding number of a triangle soup (m, 3, 3), by libigl.

    Fast winding numbers (Barill et al. 2018): `accuracy` is how many radii away a cluster of
    triangles is taken as one, `rough` and `margin` how many are enough where that is clear.
    """

    def __init__(
        self, bodies: Float64Array, accuracy: float, rough: float = 0.0, margin: float = 0.0
    ) -> None:
        self._accuracy, self._rough, self._margin = accuracy, rough or accuracy, margin
        self._tree = igl.FastWindingNumberBVH()
        self._empty = not len(bodies)
        if not self._empty:
            faces = np.arange(3 * len(bodies), dtype=np.int64).reshape(-1, 3)
            self._tree.init(np.ascontiguousarray(bodies.reshape(-1, 3)), faces)

    def at(self, points: Float64Array) -> Float64Array:
        """The winding number (n,) at points (n, 3); 0 everywhere for a soup of no triangles."""
        if self._empty or not len(points):
            return np.zeros(len(points))
        return in_space_order(partial(self._asked, self._accuracy), points)

    def about(self, points: Float64Array) -> Float64Array:
        """The same, only roughly except near a half, one and a half and so on: which side it is."""
        if self._empty or not len(points):
            return np.zeros(len(points))
        return in_space_order(self._about, points)

    def _about(self, points: Float64Array) -> Float64Array:
        number = self._asked(self._rough, points)
        unclear = np.flatnonzero(np.abs(number - np.floor(number) - 0.5) < self._margin)
        number[unclear] = self._asked(self._accuracy, points[unclear])
        return number

    def _asked(self, accuracy: float, points: Float64Array) -> Float64Array:
        number: Float64Array = self._tree.winding_number(points, accuracy)
        return number
