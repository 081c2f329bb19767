"""The sampler: random points around an asset, labeled."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.chart_error_weight import chart_error_weight
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.texture_gradient import texture_gradient
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.openings import spread_over
from nispcodec.geometry.solid import area, normals
from nispcodec.geometry.surface_points import (
    laplace_offsets,
    points_on,
    raised,
    solid_surface,
    uniform_ball,
)
from nispcodec.geometry.symmetry import asymmetric_samples

TINY = np.finfo(np.float64).tiny


class Sampler:
    """Draws and labels points around one analyzed asset; all in the normalized frame."""

    def __init__(
        self, analysis: Analysis, seed: int = 0, config: SamplingConfig = SamplingConfig()
    ) -> None:
        self.analysis, self.config = analysis, config
        # Other numbers than the analysis has: what it asks at random changes no sample.
        self._random, self._label = np.random.default_rng([seed, 1]), analysis.label

    def near_surface(self, count: int, spread: float, signed: bool = True) -> SampleSet:
        """About `count` samples whose |SDF| has the mean `spread`: `laplace_offsets`.

        With spread 1 / beta this is the density of the paper's sampler, at one query a point.
        """
        surface, _ = solid_surface(self._random, self.analysis.solid, count)
        return self._label(self._beside(surface, spread), signed)

    def undersampled_charts(self, least: int, count: int, spread: float) -> SampleSet:
        """Samples for patches that have fewer than `least` of `count` points: what they lack."""
        solid = self.analysis.solid
        sizes, patch = area(solid.pieces), self.analysis.patches.face_charts[solid.parents]
        shares = np.bincount(patch, sizes) / sizes.sum()
        lacking = np.where(shares > 0, np.maximum(least - count * shares, 0), 0)
        if not lacking.any():
            return self._label(np.zeros((0, 3)))
        weight = sizes * (lacking / np.maximum(shares, TINY))[patch]
        points, piece = points_on(self._random, solid.pieces, weight, round(lacking.sum()))
        surface = raised(self._random, solid, points, piece)
        return self._label(self._beside(surface, spread), signed=False)

    def thin_walls(self, count: int, times: int, spread: float) -> SampleSet:
        """Samples about those of `count` surface points where a part is thin: `times` for each.

        No more than `count` in all. A network that misses a strap is hardly wrong in the mean.
        """
        depth, solid = self.config.thin_depth, self.analysis.solid
        surface, piece = solid_surface(self._random, solid, count)
        behind = surface - depth * normals(solid.pieces[piece])
        surface = surface[self.analysis.field.closest(behind).sdf > -depth / 4]
        again = surface.repeat(min(times, count // max(len(surface), 1)), axis=0)
        again += self._random.normal(scale=depth / 2, size=again.shape)
        return self._label(self._beside(again, spread))

    def cube(self, count: int) -> SampleSet:
        """`count` samples uniform in the cube that anybody asks about."""
        half = self.analysis.config.cube
        return self._label(self._random.uniform(-half, half, size=(count, 3)))

    def importance(self, count: int) -> SampleSet:
        """The paper's sampler: uniform in the unit ball, kept with weight exp(-beta |SDF|)."""
        candidates = uniform_ball(self._random, 10 * count)
        # The weight needs no sign, which would take most of the time.
        distance = np.abs(self.analysis.field.closest(candidates, signed=False).sdf)
        weight = np.exp(-self.config.beta * distance)
        chosen = self._random.choice(len(candidates), count, p=weight / weight.sum())
        return self._label(candidates[chosen])

    def surface(self, count: int) -> SampleSet:
        """`count` samples uniform by area on the outer faces and both sides of open surfaces."""
        points, _ = solid_surface(self._random, self.analysis.solid, count)
        return self._label(points, signed=False)

    def asymmetric(self, count: int, spread: float) -> list[SampleSet]:
        """Of `count` mirror images of points near the surface those unlike the points themselves.

        A set for each signed axis of the SDF.
        """
        signed_axes = self.analysis.symmetry.sdf >> 3
        if not signed_axes:
            return []
        near = self.near_surface(count, spread)
        alike = self.analysis.config.symmetry.alike
        return asymmetric_samples(self._label, near, signed_axes, alike)

    def closing_surface(self, count: int) -> SampleSet:
        """Samples where the SDF closes openings, on the openings' chart; 0 without openings."""
        analysis = self.analysis
        if not analysis.table.openings:
            return self._label(np.zeros((0, 3)))
        seeds, how = analysis.closing_points, analysis.config.openings
        points = spread_over(analysis.field, seeds, count, self._random, how)
        away = 0.3 * analysis.field.closest(points, signed=False).sdf[:, None]
        jitter = np.clip(away, 0, self.config.closing_jitter)
        samples = self._label(points + self._random.normal(size=points.shape) * jitter, False)
        return replace(
            samples,
            chart=np.full(len(points), len(analysis.table) - 1, np.int32),
            uv=np.zeros_like(samples.uv),
        )

    def by_texture_gradient(self, samples: SampleSet, count: int) -> SampleSet:
        """`count` samples again, the more the texture changes there; 0 where it never does."""
        mesh, table = self.analysis.mesh, self.analysis.table
        weight = texture_gradient(mesh, table, samples, self.config.texture_step)
        return self._again(samples, weight, count)

    def by_chart_error(self, samples: SampleSet, count: int) -> SampleSet:
        """`count` samples again, the more a wrong chart is seen there; 0 where it never is."""
        mesh, table = self.analysis.mesh, self.analysis.table
        weight = chart_error_weight(mesh, table, samples, self.config.chart_neighbors)
        return self._again(samples, weight, count)

    def _again(self, samples: SampleSet, weight: Float64Array, count: int) -> SampleSet:
        if not weight.any():
            return samples[:0]
        return samples[self._random.choice(len(samples), count, p=weight / weight.sum())]

    def _beside(self, surface: Float64Array, spread: float) -> Float64Array:
        return laplace_offsets(self._random, surface, spread, self.analysis.config.cube)
