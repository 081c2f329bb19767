"""Positions rounded to a grid so that the surface stays: vertices slide along it to a grid point.

The nearest grid point moves a vertex in every direction alike. Of those around it one is often
farther off, but nearer to the surface, or makes up for what others move it by.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.simplify.closest import unit
from nispcodec.simplify.config import RoundingConfig
from nispcodec.simplify.curves import border_sides, ends_of, seam_sides
from nispcodec.simplify.retreat import crosses, without_turns
from nispcodec.simplify.triangles import Triangles

AROUND = np.array(list(product((-1, 0, 1), repeat=3)), np.float64)


def rounded_along(
    triangles: Triangles, places: Float64Array, config: RoundingConfig, seed: int
) -> Float64Array:
    """Integers (n, 3) for the vertices at places (n, 3), in steps of a grid, within their range.

    Where a face would turn over its vertices are at the nearest.
    """
    nearest = np.rint(places)
    found, weighed = nearest, _Weighed.of(triangles, config)
    rng = np.random.default_rng([seed, 3])
    for sweep in range(config.sweeps):
        best = weighed.best(places, found if sweep else None)
        # Neighbors that move at once would not see each other.
        moved = rng.random(len(best)) < config.share if sweep else np.ones(len(best), np.bool_)
        found = np.where(moved[:, None], best, found)
    found = np.clip(found, nearest.min(axis=0), nearest.max(axis=0))
    return without_turns(triangles.faces, nearest, found, config.turn, 0)


@dataclass(frozen=True)
class _Weighed:
    """What it costs to move vertices.

    faces, normals, areas  (m, 3), (m, 3), (m,): a face is off by the mean over it of squares of
                           what lies across
    own                    (n, 3, 3): the quadric of each vertex by itself
    """

    faces: Int64Array
    normals: Float64Array
    areas: Float64Array
    own: Float64Array

    @staticmethod
    def of(triangles: Triangles, config: RoundingConfig) -> _Weighed:
        both = crosses(triangles.faces, triangles.positions)
        areas, normals = np.linalg.norm(both, axis=1), unit(both)
        squares = areas[:, None, None] * normals[:, :, None] * normals[:, None, :]
        own = _at_corners(triangles, squares)
        weights = _at_corners(triangles, areas)[:, None, None]
        return _Weighed(
            triangles.faces,
            normals,
            areas,
            own + weights * (config.sliding * np.eye(3) + config.seam * _beside_seams(triangles)),
        )

    def best(self, places: Float64Array, others: Float64Array | None) -> Float64Array:
        """(n, 3): the best of the integers around each place; others: where its neighbors are."""
        nearest = np.rint(places)
        pull = np.zeros_like(places) if others is None else self._pull(others - places)
        found, least = nearest, np.full(len(places), np.inf)
        for step in AROUND:
            way = nearest + step - places
            cost = np.einsum("ni,nij,nj->n", way, self.own, way) + (way * pull).sum(axis=1)
            found = np.where((cost < least)[:, None], nearest + step, found)
            least = np.minimum(cost, least)
        return found

    def _pull(self, ways: Float64Array) -> Float64Array:
        """(n, 3): by how much a vertex costs more along its way, for those of its neighbors."""
        across = np.einsum("md,mkd->mk", self.normals, ways[self.faces])
        others = self.areas[:, None] * (across.sum(axis=1, keepdims=True) - across)
        pull = np.zeros_like(ways)
        for corner in range(3):
            np.add.at(pull, self.faces[:, corner], others[:, corner, None] * self.normals)
        return pull


def _at_corners(triangles: Triangles, values: Float64Array) -> Float64Array:
    """(n, ...): of faces' values (m, ...), the sum over those of each vertex."""
    found = np.zeros((len(triangles.positions), *values.shape[1:]))
    for corner in range(3):
        np.add.at(found, triangles.faces[:, corner], values)
    return found


def _beside_seams(triangles: Triangles) -> Float64Array:
    """(n, 3, 3): the quadric of what lies beside the seams and borders of each vertex."""
    found = np.zeros((len(triangles.positions), 3, 3))
    ends = ends_of(triangles, border_sides(triangles) | seam_sides(triangles))
    along = unit(triangles.positions[ends[:, 1]] - triangles.positions[ends[:, 0]])
    beside = np.eye(3) - along[:, :, None] * along[:, None, :]
    counts = np.maximum(np.bincount(ends.ravel(), minlength=len(found)), 1)
    for end in range(2):
        np.add.at(found, ends[:, end], beside)
    return found / counts[:, None, None]
