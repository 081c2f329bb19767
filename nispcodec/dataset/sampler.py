"""The sampler: draws points around a mesh and labels them."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import ChartTable, Frame
from nispcodec.dataset.chart_error_weight import confusion
from nispcodec.dataset.sample_set import SampleSet
from nispcodec.dataset.texture_gradient import detail
from nispcodec.geometry.chart_cuts import split_self_seams
from nispcodec.geometry.chart_merging import Cover, merge_charts
from nispcodec.geometry.charts import Charts, split_charts
from nispcodec.geometry.distance import Closest, DistanceField
from nispcodec.geometry.openings import crossings, spread_over
from nispcodec.geometry.solid import SHELL, area, build_solid, normals
from nispcodec.geometry.surface_points import barycentric, points_on, uniform_ball, uniform_surface
from nispcodec.geometry.symmetry import folded, mirrors, twins, unlike

BETA = 60.0
"""Importance exp(-BETA |SDF|) of a point (paper, eq. 5)."""

CUBE = 1.05
"""Half the side of the cube that far samples fill; the extraction looks inside 1.02."""

MERGE_POINTS = 30_000
MERGE_RARE = 20

OPENING_PROBES = 50_000
OPENING_SHARE = 5e-4
"""From this share of probes near the surface that cross a membrane on, openings get a chart."""

FULL = 0.95
"""UVs that fill so much of the unit square in both directions stay as they are: no map to store."""

TINY = 1e-12
"""A share of the area that is none."""

THIN = 4e-3
"""What ends less than a quarter of this deeper than it (normalized frame) is thin."""

MEMBRANE_JITTER = 5e-3
"""How far off a membrane (normalized frame) a network may put it."""


class Sampler:
    """Draws and labels points around one mesh.

    `gap` > 0 cuts charts that meet themselves (`split_self_seams`), then lets charts that are
    further apart than that share a number (`merge_charts`), and gives openings a chart. `mirrors`
    says about which planes the asset is symmetric.
    """

    def __init__(self, mesh: TexturedMesh, seed: int, gap: float = 0.0) -> None:
        self._mesh = mesh
        self.frame = normalizing_frame(mesh)
        self._random = np.random.default_rng(seed)
        self._corners = self.frame.to_normalized(mesh.corners)
        self._uvs = mesh.corner_uvs
        self.solid = build_solid(self._corners)
        self.field = DistanceField(self.solid)
        self.charts = split_charts(mesh)
        if gap > 0:
            self.charts = split_self_seams(mesh, self.charts)
        self.patches = self.charts
        self.table = chart_table(mesh, self.charts)
        self.mirrors = mirrors(self.label, self.solid.pieces)
        self._crossings = np.zeros((0, 3))
        if gap > 0:
            self.charts = self._merged(gap)
            self.table = chart_table(mesh, self.charts)
            self._find_openings()

    def near(self, count: int, spread: float, signed: bool = True) -> SampleSet:
        """Points whose |SDF| is exponentially distributed with mean `spread` (exact on a plane).

        A surface point moves in a random direction by a Gamma(2, spread) distance: the part of
        that along the normal is Laplace-distributed, and edges are surrounded from all sides.
        With spread 1 / BETA this is the density of the paper's sampler, at one query a point.
        """
        return self.label(self._beside(self._surface(count)[0], spread), signed)

    def scarce(self, least: int, count: int, spread: float) -> SampleSet:
        """What patches lack that have fewer than `least` of `count` points: so many beside each."""
        sizes, patch = area(self.solid.pieces), self.patches.face_charts[self.solid.parents]
        shares = np.bincount(patch, sizes) / sizes.sum()
        lacking = np.where(shares > 0, np.maximum(least - count * shares, 0), 0)
        if not lacking.any():
            return self.label(np.zeros((0, 3)))
        weight = sizes * (lacking / np.maximum(shares, TINY))[patch]
        found = points_on(self._random, self.solid.pieces, weight, round(lacking.sum()))
        return self.label(self._beside(self._raised(*found), spread), signed=False)

    def thin(self, count: int, times: int, spread: float) -> SampleSet:
        """As `near`, about those of `count` surface points where a part is thin: `times` for each.

        No more than `count` in all. A network that misses a strap is hardly wrong in the mean.
        """
        surface, piece = self._surface(count)
        behind = surface - THIN * normals(self.solid.pieces[piece])
        surface = surface[self.field.closest(behind).sdf > -THIN / 4]
        again = surface.repeat(min(times, count // max(len(surface), 1)), axis=0)
        again += self._random.normal(scale=THIN / 2, size=again.shape)
        return self.label(self._beside(again, spread))

    def cube(self, count: int) -> SampleSet:
        """Points uniform in the cube [-CUBE, CUBE]^3."""
        return self.label(self._random.uniform(-CUBE, CUBE, size=(count, 3)))

    def importance(self, count: int) -> SampleSet:
        """The paper's sampler: uniform in the unit ball, kept with weight exp(-BETA |SDF|)."""
        candidates = uniform_ball(self._random, 10 * count)
        # The weight needs no sign, which would take most of the time.
        weight = np.exp(-BETA * np.abs(self.field.closest(candidates, signed=False).sdf))
        chosen = self._random.choice(len(candidates), count, p=weight / weight.sum())
        return self.label(candidates[chosen])

    def surface(self, count: int) -> SampleSet:
        """Points uniform by area on the outer faces and on both sides of sheets."""
        return self.label(self._surface(count)[0], signed=False)

    def unlike(self, count: int, spread: float) -> list[SampleSet]:
        """Of `count` mirror images of points near the surface those told by their side only."""
        sided = self.mirrors.sdf >> 3
        return unlike(self.label, self.near(count, spread), sided) if sided else []

    def membrane(self, count: int) -> SampleSet:
        """Points near where the SDF closes openings, on the openings' chart; 0 without openings."""
        if not self.table.openings:
            return self.label(np.zeros((0, 3)))
        points = spread_over(self.field, self._crossings, count, self._random)
        away = 0.3 * self.field.closest(points, signed=False).sdf[:, None]
        points += self._random.normal(size=points.shape) * np.clip(away, 0, MEMBRANE_JITTER)
        samples = self.label(points, signed=False)
        return replace(
            samples,
            chart=np.full(len(points), len(self.table) - 1, np.int32),
            uv=np.zeros_like(samples.uv),
        )

    def detailed(self, samples: SampleSet, count: int) -> SampleSet:
        """`count` samples again, the more the texture changes there; 0 where it never does."""
        return self._again(samples, detail(self._mesh, self.table, samples), count)

    def confusing(self, samples: SampleSet, count: int) -> SampleSet:
        """`count` samples again, the more a wrong chart is seen there; 0 where it never is."""
        return self._again(samples, confusion(self._mesh, self.table, samples), count)

    def _again(self, samples: SampleSet, wanted: Float64Array, count: int) -> SampleSet:
        if not wanted.any():
            return samples[:0]
        return samples[self._random.choice(len(samples), count, p=wanted / wanted.sum())]

    def label(self, points: Float64Array, signed: bool = True) -> SampleSet:
        """Distance, chart and UV at each point's closest surface point (paper, eq. 2)."""
        closest = self.field.closest(points, signed)
        face = self.solid.parents[closest.piece]
        return SampleSet(
            points=points.astype(np.float32),
            sdf=closest.sdf.astype(np.float32),
            chart=self.charts.face_charts[face],
            uv=self._network_uv(closest, face),
        )

    def _find_openings(self) -> None:
        probes = self.near(OPENING_PROBES, 1 / BETA, signed=False).points.astype(np.float64)
        self._crossings = crossings(self.field, probes, self._random)
        if len(self._crossings) >= OPENING_SHARE * len(probes):
            self.table = replace(
                self.table,
                materials=np.append(self.table.materials, np.int32(0)),
                has_uv=np.append(self.table.has_uv, False),
                openings=True,
            )

    def _beside(self, surface: Float64Array, spread: float) -> Float64Array:
        direction = self._random.normal(size=surface.shape)
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        points = surface + direction * self._random.gamma(2.0, spread, size=(len(surface), 1))
        return points[np.abs(points).max(axis=1) <= CUBE]

    def _surface(self, count: int) -> tuple[Float64Array, Int64Array]:
        points, piece = uniform_surface(self._random, self.solid.pieces, count)
        return self._raised(points, piece), piece

    def _raised(self, points: Float64Array, piece: Int64Array) -> Float64Array:
        """Points (n, 3) on pieces (n,), those on sheets moved to where the thickness ends.

        In front of one of two faces back to back; of a single one on either side.
        """
        sheet = np.flatnonzero(self.solid.sheet[piece])
        on = piece[sheet]
        side = np.where(self.solid.wall[on] | (self._random.random(len(on)) < 0.5), 1.0, -1.0)
        points[sheet] += (SHELL * side)[:, None] * normals(self.solid.pieces[on])
        return points

    def _merged(self, gap: float) -> Charts:
        """Merge charts, told by random points and one point of each piece of small charts."""
        points, piece = self._surface(MERGE_POINTS)
        chart = self.charts.face_charts[self.solid.parents]
        rare = np.bincount(chart[piece], minlength=len(self.charts))[chart] < MERGE_RARE
        centers = self._raised(self.solid.pieces[rare].mean(axis=1), np.flatnonzero(rare))
        points = np.concatenate([points, centers])
        surface = self.label(points, signed=False)
        seen, uvs = folded(points, self.mirrors.uv), surface.uv.astype(np.float64)
        cover = Cover(points, surface.chart, seen, uvs)
        alike = twins(partial(self.label, signed=False), surface, self.mirrors.uv)
        return merge_charts(self.charts, cover, alike, gap)

    def _network_uv(self, closest: Closest, face: Int64Array) -> Float32Array:
        weights = barycentric(self._corners[face], closest.point)
        uv = np.einsum("nc,ncx->nx", weights, self._uvs[face])
        scaled = (uv - np.asarray(self.table.uv_offset)) / np.asarray(self.table.uv_scale)
        has_uv = self.charts.has_uv[self.charts.face_charts[face]]
        return np.where(has_uv[:, None], scaled, 0.0).astype(np.float32)


def normalizing_frame(mesh: TexturedMesh) -> Frame:
    """Bounding-box center to 0, farthest vertex to radius 1; only vertices of faces count."""
    used = mesh.positions[np.unique(mesh.faces)]
    center = (used.min(axis=0) + used.max(axis=0)) / 2
    radius = float(np.linalg.norm(used - center, axis=1).max())
    return Frame((float(center[0]), float(center[1]), float(center[2])), radius)


def chart_table(mesh: TexturedMesh, charts: Charts) -> ChartTable:
    """The chart table, with the affine map that brings the used UVs to [0, 1]^2.

    The identity where they lie within the unit square and all but fill it: it takes no bytes.
    """
    used = mesh.corner_uvs[mesh.has_uv].reshape(-1, 2)
    if not len(used):
        return ChartTable(charts.materials, charts.has_uv)
    low, high = used.min(axis=0), used.max(axis=0)
    if low.min() >= 0 and high.max() <= 1 and (high - low).min() >= FULL:
        return ChartTable(charts.materials, charts.has_uv)
    scale = np.where(high > low, high - low, 1.0)
    return ChartTable(
        charts.materials,
        charts.has_uv,
        uv_offset=(float(low[0]), float(low[1])),
        uv_scale=(float(scale[0]), float(scale[1])),
    )
