"""Exact signed distance to a solid, and where on the mesh the closest surface point lies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.nearest import NearestTriangles
from nispcodec.geometry.solid import Solid

NEAREST = np.sqrt(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Closest:
    """The closest surface points of n points, normalized frame.

    sdf    (n,) signed distance, negative inside
    piece  (n,) index of the closest piece of the solid
    point  (n, 3) the closest point on it
    sheet  (n,) bool: whether that is on an open surface, which ends half its thickness further out
    """

    sdf: Float64Array
    piece: Int64Array
    point: Float64Array
    sheet: BoolArray

    def __getitem__(self, chosen: Int64Array | slice) -> Closest:
        return Closest(self.sdf[chosen], self.piece[chosen], self.point[chosen], self.sheet[chosen])


class DistanceField:
    """The union of the bodies and of the open surfaces, thickened, as a signed distance.

    Normalized frame. libigl's own signed distance scales magnitudes by the winding number, so
    magnitude and sign are computed apart: exact point-triangle distance, and inside where |winding
    number| > 1/2 (Jacobson et al. 2013). Where the closest wall faces a point it tells the side at
    no cost: no surface is between them.
    """

    def __init__(self, solid: Solid, config: SolidConfig = SolidConfig()) -> None:
        self.solid, self._config = solid, config

    @cached_property
    def _walls(self) -> _Tree:
        return _Tree(self.solid.pieces, self.solid.wall)

    @cached_property
    def _sheets(self) -> _Tree:
        lifted = self.solid.pieces + self._config.sheet_lift * self.solid.normals[:, None]
        return _Tree(lifted, self.solid.open_surface)

    def forget(self) -> None:
        """Free the trees, which grow again for the next question."""
        self.solid.winding.forget()
        for name in ("_walls", "_sheets"):
            vars(self).pop(name, None)

    def closest(self, points: Float64Array, signed: bool = True) -> Closest:
        """Signed distance (negative inside) and closest surface point of (n, 3) points.

        Without `signed` all of space counts as outside, which saves most of the time.
        """
        return self._found(points, (signed,))[0]

    def both(self, points: Float64Array) -> tuple[Closest, Closest]:
        """`closest` of points (n, 3) with signs, and without, for hardly more than one of them."""
        signed, unsigned = self._found(points, (True, False))
        return signed, unsigned

    def _found(self, points: Float64Array, signs: tuple[bool, ...]) -> list[Closest]:
        points = np.ascontiguousarray(points, dtype=np.float64)
        walls, sheets = self._walls.closest(points), self._sheets.closest(points)
        found = []
        for signed in signs:
            sdf = walls.sdf.copy()
            if signed:
                sdf[self._inside(points, walls)] *= -1
            found.append(self._thickened(replace(walls, sdf=sdf), sheets))
        return found

    def _thickened(self, walls: Closest, sheets: Closest) -> Closest:
        """The walls, and sheets where they are nearer."""
        thick = sheets.sdf - self.solid.half_thickness
        nearer = thick < walls.sdf
        if not nearer.any():
            return walls
        return Closest(
            np.where(nearer, thick, walls.sdf),
            np.where(nearer, sheets.piece, walls.piece),
            np.where(nearer[:, None], sheets.point, walls.point),
            nearer,
        )

    def nearer(
        self, points: Float64Array, closest: Closest, share: float
    ) -> tuple[Float64Array, Closest]:
        """Points (n, 3) moved to a share of their distance, and what is closest to them, unsigned.

        They move on the way to their closest points. `closest` has no signs. No query is needed, as
        a ball around a point that ends at the surface is empty; but for points within thickened
        surfaces, which move out of them.
        """
        skin = np.where(closest.sheet, self.solid.half_thickness, 0.0)
        length = np.maximum(closest.sdf + skin, NEAREST)
        scale = (share * closest.sdf + skin) / length
        moved = closest.point + (points - closest.point) * scale[:, None]
        found = replace(closest, sdf=share * closest.sdf)
        within = np.flatnonzero(closest.sdf < 0)
        if not len(within):
            return moved, found
        again = self.closest(moved[within], signed=False)
        for name, values in vars(found).items():
            values = values.copy()
            values[within] = getattr(again, name)
            found = replace(found, **{name: values})
        return moved, found

    def _inside(self, points: Float64Array, walls: Closest) -> BoolArray:
        """As `inside`, by the closest walls where they tell: these are unsigned, as yet."""
        solid, away = self.solid, points - walls.point
        along = np.einsum("nx,nx->n", away, solid.normals[walls.piece])
        told = np.abs(along) > self._config.facing * walls.sdf
        # Next to a wall the way to it is lost in rounding.
        told &= (walls.sdf < solid.reach[walls.piece]) & (walls.sdf > NEAREST)
        found = (along > 0) == solid.inside_front[walls.piece]
        rest = np.flatnonzero(~told)
        found[rest] = self.inside(points[rest])
        return found

    def inside(self, points: Float64Array) -> BoolArray:
        """(n,) bool: which points (n, 3) lie inside the bodies; open surfaces are left out."""
        return np.abs(self.solid.winding.about(points)) > 0.5


class _Tree:
    """Unsigned distance to some of the pieces; infinitely far when there are none."""

    def __init__(self, pieces: Float64Array, chosen: BoolArray) -> None:
        self.index = np.flatnonzero(chosen)
        self.triangles = NearestTriangles(pieces[self.index]) if len(self.index) else None

    def closest(self, points: Float64Array) -> Closest:
        """The closest points to points (n, 3)."""
        on_sheet = np.zeros(len(points), dtype=bool)
        if self.triangles is None:
            nowhere = np.zeros(len(points), dtype=np.int64)
            return Closest(np.full(len(points), np.inf), nowhere, np.zeros_like(points), on_sheet)
        found = self.triangles.closest(points)
        return Closest(found.distances, self.index[found.faces], found.positions, on_sheet)
