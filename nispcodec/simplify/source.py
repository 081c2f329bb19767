"""The surface that a simplified mesh is fitted to: its points, borders and seams."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.core.creases import fan_normals
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.curves import Segments, border_sides, ends_of, seam_sides
from nispcodec.simplify.triangles import Triangles


@dataclass(frozen=True)
class Source:
    """Triangles, and what is computed of them once for all that is fitted to them."""

    triangles: Triangles

    @cached_property
    def tree(self) -> Tree:
        """For closest points."""
        return Tree(self.triangles.corners)

    def forget(self) -> None:
        """Free what takes most memory; it is computed again for the next question."""
        self.tree.forget()
        vars(self).pop("corner_normals", None)

    @cached_property
    def corner_normals(self) -> Float64Array:
        """(m, 3, 3): the normals that corners are shaded with; creases must be known."""
        triangles, creases = self.triangles, self.triangles.creases
        assert creases is not None
        normals, fans = fan_normals(triangles.faces, triangles.corners, creases)
        return normals[fans]

    @cached_property
    def borders(self) -> Segments:
        """Edges of one face."""
        return self._segments(border_sides(self.triangles))

    @cached_property
    def seams(self) -> Segments:
        """Edges between charts."""
        return self._segments(seam_sides(self.triangles))

    def normals_at(self, points: Float64Array) -> Float64Array:
        """(n, 3): the normals of the surface at the points closest to (n, 3) points."""
        if not len(points):
            return np.zeros((0, 3))
        return self.tree.normals[self.tree.closest(points).faces]

    def _segments(self, sides: BoolArray) -> Segments:
        ends = ends_of(self.triangles, sides)
        first, second = np.moveaxis(self.triangles.positions[ends], 1, 0)
        return Segments(first, second)
