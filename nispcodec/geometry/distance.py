"""Exact signed distance to a solid, and where on the mesh the closest surface point lies."""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.solid import Solid
from nispcodec.geometry.z_order import z_order


@dataclass(frozen=True)
class Closest:
    """The closest surface points of n points, normalized frame.

    sdf    (n,) signed distance, negative inside
    piece  (n,) index of the closest piece of the solid
    point  (n, 3) the closest point on it
    """

    sdf: Float64Array
    piece: Int64Array
    point: Float64Array


class DistanceField:
    """The union of the bodies and of the open surfaces, thickened, as a signed distance.

    Normalized frame. libigl's own signed distance scales magnitudes by the winding number, so
    magnitude and sign are computed apart: exact point-triangle distance, and inside where |winding
    number| > 1/2 (Jacobson et al. 2013).
    """

    def __init__(self, solid: Solid, sheet_lift: float = SolidConfig.sheet_lift) -> None:
        self.solid = solid
        self._walls = _Tree(solid.pieces, solid.wall)
        lifted = solid.pieces + sheet_lift * solid.normals[:, None]
        self._sheets = _Tree(lifted, solid.open_surface)

    def closest(self, points: Float64Array, signed: bool = True) -> Closest:
        """Signed distance (negative inside) and closest surface point of (n, 3) points.

        Without `signed` all of space counts as outside, which saves most of the time.
        """
        points = np.ascontiguousarray(points, dtype=np.float64)
        walls, sheets = self._walls.closest(points), self._sheets.closest(points)
        inside = self.inside(points) if signed else np.zeros(len(points), dtype=bool)
        distance = np.where(inside, -walls.sdf, walls.sdf)
        thick = sheets.sdf - self.solid.half_thickness
        nearer = thick < distance
        return Closest(
            sdf=np.where(nearer, thick, distance),
            piece=np.where(nearer, sheets.piece, walls.piece),
            point=np.where(nearer[:, None], sheets.point, walls.point),
        )

    def inside(self, points: Float64Array) -> BoolArray:
        """(n,) bool: which points (n, 3) lie inside the bodies; open surfaces are left out."""
        return np.abs(self.solid.winding.at(points)) > 0.5


class _Tree:
    """Unsigned distance to some of the pieces; infinitely far when there are none."""

    def __init__(self, pieces: Float64Array, chosen: BoolArray) -> None:
        self.index = np.flatnonzero(chosen)
        triangles = pieces[self.index]
        self.vertices = np.ascontiguousarray(triangles.reshape(-1, 3))
        self.faces = np.arange(3 * len(triangles), dtype=np.int64).reshape(-1, 3)
        self.tree = igl.AABB()
        if len(self.faces):
            self.tree.init(self.vertices, self.faces)

    def closest(self, points: Float64Array) -> Closest:
        if not len(self.faces) or not len(points):
            nowhere = np.zeros(len(points), dtype=np.int64)
            return Closest(np.full(len(points), np.inf), nowhere, np.zeros_like(points))
        order = z_order(points)
        back = np.argsort(order)
        found = self.tree.squared_distance(self.vertices, self.faces, points[order])
        squared, face, point = (each[back] for each in found)
        return Closest(np.sqrt(squared), self.index[face], point)
