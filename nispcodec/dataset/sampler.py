"""The sampler: random points around an asset, labeled."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.sample_set import SampleSet
from nispcodec.dataset.chart_error_weight import chart_error_weight
from nispcodec.dataset.config import SamplingConfig
from nispcodec.dataset.texture_gradient import texture_gradient
from nispcodec.geometry.analysis import Analysis
from nispcodec.geometry.openings import spread_over
from nispcodec.geometry.surface_points import (
    laplace_offsets,
    points_on,
    raised,
    solid_surface,
    uniform_ball,
)
from nispcodec.geometry.symmetry import asymmetric_samples
from nispcodec.geometry.triangles import area

TINY = np.finfo(np.float64).tiny
BLOCK = 1 << 16


class Sampler:
    """Random points around one analyzed asset, labeled; all in the normalized frame.

    The same seed and the same calls in the same order give the same samples. Counts are of samples,
    spreads are the mean |SDF| on a plane; without `signed` all of space counts as outside.
    """

    def __init__(
        self, analysis: Analysis, seed: int = 0, config: SamplingConfig = SamplingConfig()
    ) -> None:
        self.analysis, self.config = analysis, config
        # Other numbers than the analysis has: what it asks at random changes no sample.
        self._random, self._label = np.random.default_rng([seed, 1]), analysis.label

    def near_surface(self, count: int, spread: float, signed: bool = True) -> SampleSet:
        """Up to `count` samples beside the surface, as `laplace_offsets` has them.

        With spread 1 / beta this is the density of the paper's sampler, at one distance query for
        each point.
        """
        surface, _ = solid_surface(self._random, self.analysis.solid, count)
        return self._label(self._beside(surface, spread), signed)

    def near_and_nearer(
        self, count: int, spread: float, nearer: Sequence[tuple[int, float]]
    ) -> tuple[SampleSet, ...]:
        """`near_surface`, signed, and further sets without signs, at its distance queries alone.

        `nearer` has the count and spread of each. They lie on the ways from the same points to the
        surface, each at its share of the way: sets for networks of different kinds.
        """
        wanted = [(count, spread), *nearer]
        most = max(number for number, wide in wanted if wide <= spread)
        surface, _ = solid_surface(self._random, self.analysis.solid, most)
        points = self._beside(surface, spread)
        found: list[list[SampleSet]] = [[] for _ in wanted]
        for number, (other, wide) in enumerate(wanted):
            if wide > spread:
                found[number].append(self.near_surface(other, wide, signed=False))
        for start in range(0, len(points), BLOCK):
            self._add_block(found, points[start : start + BLOCK], start, wanted)
        return tuple(SampleSet.joined(tuple(each)) for each in found)

    def _add_block(
        self,
        found: list[list[SampleSet]],
        points: Float64Array,
        start: int,
        wanted: Sequence[tuple[int, float]],
    ) -> None:
        """Label points (n, 3), the first of them number `start`, for all sets that want them."""
        field, spread = self.analysis.field, wanted[0][1]
        signed, unsigned = field.both(points)
        for number, (count, wide) in enumerate(wanted):
            used = slice(max(count - start, 0))
            if number == 0:
                found[number].append(self._label.of(points[used], signed[used]))
            elif wide <= spread:
                moved, closest = field.nearer(points[used], unsigned[used], wide / spread)
                found[number].append(self._label.of(moved, closest))

    def undersampled_charts(self, least: int, count: int, spread: float) -> SampleSet:
        """Samples beside patches that would get fewer than `least` of `count`: what they lack."""
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
        """Samples near those of `count` surface points where a part is thin: `times` for each.

        Up to `count` in all. A network that misses a strap is hardly wrong in the mean.
        """
        depth, solid = self.config.thin_depth, self.analysis.solid
        surface, piece = solid_surface(self._random, solid, count)
        behind = surface - depth * solid.normals[piece]
        surface = surface[self.analysis.field.closest(behind).sdf > -depth / 4]
        again = surface.repeat(min(times, count // max(len(surface), 1)), axis=0)
        again += self._random.normal(scale=depth / 2, size=again.shape)
        return self._label(self._beside(again, spread))

    def cube(self, count: int) -> SampleSet:
        """`count` samples uniform in the cube of `GeometryConfig.cube`."""
        half = self.analysis.config.cube
        return self._label(self._random.uniform(-half, half, size=(count, 3)))

    def importance(self, count: int) -> SampleSet:
        """`count` samples of the unit ball by the weight exp(-beta |SDF|) (paper, eq. 5)."""
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
        """A set for each signed axis of the SDF: where the asset is not like its mirror image.

        These are some of the mirror images of `count` points near the surface.
        """
        signed_axes = self.analysis.symmetry.sdf >> 3
        if not signed_axes:
            return []
        near = self.near_surface(count, spread)
        alike = self.analysis.config.symmetry.alike
        return asymmetric_samples(self._label, near, signed_axes, alike)

    def closing_surface(self, count: int) -> SampleSet:
        """Up to `count` samples where the SDF closes openings, on their chart; none without."""
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
        """`count` of the samples, the likelier the more the texture changes there.

        None where it never does. Raises MeshError for a texture that does not decode.
        """
        mesh, table = self.analysis.mesh, self.analysis.table
        weight = texture_gradient(mesh, table, samples, self.config.texture_step)
        return self._again(samples, weight, count)

    def by_chart_error(self, samples: SampleSet, count: int) -> SampleSet:
        """`count` of the samples, the likelier the more a wrong chart is seen there.

        None where it never is. Raises MeshError for a texture that does not decode.
        """
        mesh, table = self.analysis.mesh, self.analysis.table
        weight = chart_error_weight(mesh, table, samples, self.config.chart_neighbors)
        return self._again(samples, weight, count)

    def _again(self, samples: SampleSet, weight: Float64Array, count: int) -> SampleSet:
        if not weight.any():
            return samples[:0]
        return samples[self._random.choice(len(samples), count, p=weight / weight.sum())]

    def _beside(self, surface: Float64Array, spread: float) -> Float64Array:
        return laplace_offsets(self._random, surface, spread, self.analysis.config.cube)
