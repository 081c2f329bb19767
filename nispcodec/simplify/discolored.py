"""Where a simplified surface shows another color than the original: a label that is gone, say."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.metrics.surface import Surface
from nispcodec.simplify.config import DiscoloredConfig
from nispcodec.simplify.errors import Original


@dataclass(frozen=True)
class Discolored:
    """Points (n,) bool of an original around which another surface has other colors.

    Seams that are a little off do not count: colors are means over some neighbors of each point.
    """

    original: Original
    points: BoolArray
    config: DiscoloredConfig

    @staticmethod
    def of(original: Original, decoded: TexturedMesh, config: DiscoloredConfig) -> Discolored:
        """Those of a mesh in the normalized frame; none where colors are not known."""
        points = original.points
        if original.paint is None or len(points) < config.neighbors:
            return Discolored(original, np.zeros(len(points), np.bool_), config)
        other = Surface(decoded, decoded.positions)
        misses = original.paint.differences(original.surface, other, original.matches(other))
        around = cKDTree(points.positions).query(points.positions, config.neighbors)[1]
        seen = np.sqrt(np.square(misses[around].mean(axis=1)).mean(axis=1))
        return Discolored(original, np.asarray(seen > config.notable), config)

    @cached_property
    def share(self) -> float:
        """The part of the points."""
        return float(self.points.mean())

    @property
    def faulty(self) -> FaultyPoints:
        """The points."""
        return FaultyPoints.of(self.original.surface.mesh, self.original.points, self.points)

    @cached_property
    def corners(self) -> Float64Array:
        """(k, 3): the original's vertices beside these points, and the corners of faces there.

        Walls that nobody sees have no points, and large faces no vertices: both hold what is shown.
        """
        places, mesh = self.original.points.positions, self.original.surface.mesh
        tree, beside = cKDTree(places[self.points]), self.config.beside
        faces = np.unique(self.original.points.faces[tree.query(places)[0] <= beside])
        near = tree.query(mesh.positions, distance_upper_bound=beside)[0] <= beside
        near[mesh.faces[faces]] = True
        return np.asarray(mesh.positions[near], np.float64)
