"""Which parts of a surface can be seen from outside, by the winding number beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.metrics.surface import Surface, SurfacePoints

PROBE = 2e-3
# Half the time of libigl's default of 2; of 200,000 probes around a helmet of 82 bodies, one moved
# across 1/2.
ACCURACY = 1.5

Winding = Callable[[Float64Array], Float64Array]
"""The winding numbers (n,) at points (n, 3)."""


@dataclass(frozen=True)
class Sides:
    """Which of n points are hidden (inside on both sides), which on a sheet (inside on neither).

    Both are (n,) bool.
    """

    hidden: BoolArray
    sheet: BoolArray

    @property
    def outer(self) -> BoolArray:
        """(n,) bool: at least one side is outside."""
        return ~self.hidden


def sides_of(surface: Surface, points: SurfacePoints, winding: Winding | None = None) -> Sides:
    """The sides of points on a surface, told by the winding number PROBE off along the normal.

    Outside is |winding number| <= 1/2 (Jacobson et al. 2013). Hidden faces, inside other bodies,
    cannot be held by a signed distance field. `winding` tells the number where other faces wind
    too; None: that of the surface, by libigl.
    """
    offset = PROBE * surface.normals_at(points.faces)
    winding = winding or _winding_of(surface)
    above, below = (np.abs(winding(points.positions + way)) > 0.5 for way in (offset, -offset))
    return Sides(hidden=above & below, sheet=~above & ~below)


def _winding_of(surface: Surface) -> Winding:
    import igl

    tree = igl.FastWindingNumberBVH()
    tree.init(surface.positions, surface.mesh.faces.astype(np.int64))
    return lambda points: tree.winding_number(points, ACCURACY)
