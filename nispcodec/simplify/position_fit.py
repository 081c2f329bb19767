"""Vertices moved to where the surface between them is nearest to the source, on the mean.

Closest points and sparse least squares in turn (Hoppe et al. 1993), reweighed towards the mean of
distances. Misses along the surface count little: vertices slide. Borders are pulled to the source's
borders, and seams sideways to its seams.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array
from nispcodec.simplify.closest import Hits, Tree, unit
from nispcodec.simplify.config import FitConfig
from nispcodec.simplify.curves import Segments, border_sides, ends_of, seam_sides
from nispcodec.simplify.least_squares import Pull, pulled
from nispcodec.simplify.retreat import without_turns
from nispcodec.simplify.samples import sample_count, spread
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles


def fitted_positions(
    source: Source, triangles: Triangles, config: FitConfig = FitConfig(), seed: int = 0
) -> Triangles:
    """The same faces with positions moved so that both surfaces are near each other.

    No face turns over, and no vertex is farther from the source than `FitConfig` allows.
    """
    rng = np.random.default_rng([seed, 0])
    fit = _Fit.of(source, triangles, config, rng)
    positions = triangles.positions
    reach = min(config.reach, max(config.far * fit.missed(positions), config.least_far))
    for _ in range(config.rounds):
        pulls = list(fit.pulls(positions, rng))
        moved = pulled(positions, pulls, config.damping, config.solver)
        found = _within(source, moved, reach)
        positions = without_turns(triangles.faces, positions, found, config.turn, config.halvings)
    return replace(triangles, positions=positions)


def _within(source: Source, positions: Float64Array, reach: float) -> Float64Array:
    """The positions, drawn back to the source where they are farther from it."""
    nearest = source.tree.closest(positions).positions
    off = positions - nearest
    lengths = np.maximum(np.linalg.norm(off, axis=1, keepdims=True), np.finfo(np.float64).tiny)
    drawn: Float64Array = nearest + off * np.minimum(1, reach / lengths)
    return drawn


@dataclass(frozen=True)
class _Curve:
    """Edges by their ends (k, 2), points (s, 3) of the source's curve, the length each is of."""

    ends: Int64Array
    points: Float64Array
    length: float

    @staticmethod
    def of(
        triangles: Triangles,
        sides: BoolArray,
        there: Segments,
        config: FitConfig,
        rng: np.random.Generator,
    ) -> _Curve:
        ends = ends_of(triangles, sides)
        if not len(ends) or there.length == 0:
            return _Curve(ends[:0], np.zeros((0, 3)), 0.0)
        wanted = config.curve_samples * len(ends)
        count = int(np.clip(wanted, config.curve_fewest, config.most))
        return _Curve(ends, there.spread(count, rng), there.length / count)

    def segments(self, positions: Float64Array) -> Segments:
        return Segments(positions[self.ends[:, 0]], positions[self.ends[:, 1]])


@dataclass(frozen=True)
class _Fit:
    """What stays the same while positions move.

    points   on the source, each for `area` of it
    across   the source's normals at the points of its seams
    """

    source: Source
    faces: Int64Array
    config: FitConfig
    points: Hits
    area: float
    border: _Curve
    seam: _Curve
    across: Float64Array

    @staticmethod
    def of(
        source: Source, triangles: Triangles, config: FitConfig, rng: np.random.Generator
    ) -> _Fit:
        count = sample_count(len(triangles.positions), config)
        seam = _Curve.of(triangles, seam_sides(triangles), source.seams, config, rng)
        return _Fit(
            source=source,
            faces=triangles.faces,
            config=config,
            points=spread(source.tree, count, rng),
            area=float(source.tree.areas.sum()) / count,
            border=_Curve.of(triangles, border_sides(triangles), source.borders, config, rng),
            seam=seam,
            across=source.normals_at(seam.points),
        )

    def missed(self, positions: Float64Array) -> float:
        """The mean distance from points of the source to the faces of vertices at these places."""
        near = Tree(positions[self.faces]).closest(self.points.positions)
        return float(np.linalg.norm(near.positions - self.points.positions, axis=1).mean())

    def pulls(self, positions: Float64Array, rng: np.random.Generator) -> Iterator[Pull]:
        """From points of the source, points of the moved surface, borders and seams."""
        tree = Tree(positions[self.faces])
        near = tree.closest(self.points.positions)
        misses = np.linalg.norm(near.positions - self.points.positions, axis=1)
        softness = self.config.softness * float(misses.mean()) + np.finfo(np.float64).eps
        yield self._surface(tree, near, self.points, softness)
        own = spread(tree, len(misses), rng)
        yield self._surface(tree, own, self.source.tree.closest(own.positions), softness)
        if len(self.border.ends):
            yield self._border(positions, softness)
        if len(self.seam.ends):
            yield self._seam(positions, softness)

    def _surface(self, tree: Tree, own: Hits, there: Hits, softness: float) -> Pull:
        """Points of the moved surface to points of the source, where both face the same way."""
        normals = tree.normals[own.faces]
        facing = (normals * self.source.tree.normals[there.faces]).sum(axis=1) > 0
        misses = np.linalg.norm(own.positions - there.positions, axis=1)
        weights = facing / np.maximum(misses, softness)
        vertices, sliding = self.faces[own.faces], self.config.sliding
        return Pull(vertices, own.weights, there.positions, weights, normals, sliding)

    def _border(self, positions: Float64Array, softness: float) -> Pull:
        which, shares, places = self.border.segments(positions).closest(self.border.points)
        misses = np.linalg.norm(places - self.border.points, axis=1)
        weights = self.border.length / np.sqrt(self.area) / np.maximum(misses, softness)
        return Pull(self.border.ends[which], shares, self.border.points, weights)

    def _seam(self, positions: Float64Array, softness: float) -> Pull:
        segments, points = self.seam.segments(positions), self.seam.points
        which, shares, places = segments.closest(points)
        along = unit(segments.ends[which] - segments.starts[which])
        sideways = unit(np.cross(along, self.across))
        misses = np.abs(((places - points) * sideways).sum(axis=1))
        # A seam off by a length gives a strip of that width the UVs of another chart.
        weights = self.config.seam_weight * self.seam.length / self.area
        pulls = weights / np.maximum(misses, softness)
        sliding = self.config.seam_sliding
        return Pull(self.seam.ends[which], shares, points, pulls, sideways, sliding)
