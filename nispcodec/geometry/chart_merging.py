"""Charts that share a label: mirror images, and charts far apart whose UVs go together.

A position tells such charts apart already, so the networks need a label only to keep neighbors
apart: some hundred charts become a few dozen labels. Some more make UVs easier to learn.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from nispcodec.core.arrays import Float64Array, Int32Array, IntArray
from nispcodec.geometry.charts import Charts, colored
from nispcodec.geometry.config import MergingConfig

Kind = tuple[int, bool]
"""Material of a chart, and whether it has UVs."""


@dataclass(frozen=True)
class Cover:
    """n points on the visible surface, some on every chart: all that merging looks at.

    points       (n, 3) normalized frame
    charts       (n,) before merging
    coordinates  (n, d) as the UV network sees the points: the absolute value on mirrored axes
    uvs          (n, 2) as the UV network gives them
    """

    points: Float64Array
    charts: IntArray
    coordinates: Float64Array
    uvs: Float64Array


def merge_charts(
    charts: Charts, cover: Cover, mirrored: IntArray, config: MergingConfig = MergingConfig()
) -> Charts:
    """Give one label to charts of one material: mirror images, and those further apart than a gap.

    mirrored (t, 2): pairs of charts whose UVs are the same function of `coordinates`, near or far.
    Of all charts that could share a label those do whose UVs are most nearly one affine map of the
    coordinates: that leaves the least to learn for the UV network. There are more labels than
    needed where that saves enough.
    """
    alike = (charts.materials[mirrored] == charts.materials[mirrored[:, :1]]).all(axis=1)
    group = _groups(len(charts), mirrored[alike])
    count = int(group.max()) + 1
    first = np.unique(group, return_index=True)[1]
    kinds = [(int(charts.materials[i]), bool(charts.has_uv[i])) for i in first]
    numbers = group[cover.charts]
    neighbors = _neighbors(count, cover.points, numbers, config.gap)
    _, needed = colored(neighbors, kinds)
    moments = _moments(count, cover, numbers)
    shares = config.extra_shares if count < config.many else config.extra_shares[:1]
    tried = [_Fits(moments, neighbors, kinds, _more(needed, share), config) for share in shares]
    costs = [f.mean_bits + config.worth * share for f, share in zip(tried, shares, strict=True)]
    best = tried[int(np.argmin(costs))]
    used, numbered = np.unique(best.labels, return_inverse=True)
    return Charts(
        numbered.astype(np.int32)[group][charts.face_charts],
        np.asarray([best.palette[label][0] for label in used], dtype=np.int32),
        np.asarray([best.palette[label][1] for label in used], dtype=bool),
    )


def _more(needed: Sequence[Kind], share: float) -> list[Kind]:
    """The kinds of the labels that are needed, and those with UVs so much more often."""
    textured = Counter(kind for kind in needed if kind[1])
    return [*needed, *(k for k, n in textured.items() for _ in range(math.ceil(n * share)))]


def _moments(count: int, cover: Cover, numbers: IntArray) -> Float64Array:
    """(count, d + 3, d + 3): of each chart the sums of products of coordinates, 1 and UVs."""
    ones = np.ones((len(numbers), 1))
    rows = np.hstack([cover.coordinates, ones, cover.uvs])
    size = rows.shape[1]
    products = (rows[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
    member = coo_matrix((ones[:, 0], (numbers, np.arange(len(rows)))), (count, len(rows)))
    moments: Float64Array = (member @ products).reshape(count, size, size)
    return moments


class _Fits:
    """Labels so that the UVs of each are nearly one affine map: moments of charts add up."""

    def __init__(
        self,
        moments: Float64Array,
        neighbors: list[set[int]],
        kinds: list[Kind],
        palette: Sequence[Kind],
        config: MergingConfig,
    ) -> None:
        self.config = config
        self.moments, self.neighbors, self.kinds = moments, neighbors, kinds
        most = len(palette) + len(moments)
        self.mixed = np.zeros((most, *moments.shape[1:]))
        self.bits = np.zeros(most)
        self.labels, self.palette = colored(neighbors, kinds, palette, self._choose)
        sweeps = config.sweeps if len(moments) < config.many else 0
        while sweeps and self._sweep():
            sweeps -= 1

    @property
    def mean_bits(self) -> float:
        """How far points are from their label's map, in octaves."""
        return float(self.bits.sum() / self.moments[:, -3, -3].sum())

    def _choose(self, chart: int, labels: Sequence[int], left: int | None = None) -> int:
        """The label that it costs the least to add this chart to, which is done.

        left: the one of the labels that the chart was taken from.
        """
        together = self.mixed[labels] + self.moments[chart]
        asked = together if left is None else np.concatenate([together, self.mixed[left][None]])
        bits = _bits(asked, self.config)
        if left is not None:
            self.bits[left] = bits[-1]
        best = int(np.argmin(bits[: len(labels)] - self.bits[labels]))
        label = labels[best]
        self.mixed[label], self.bits[label] = together[best], bits[best]
        return label

    def _sweep(self) -> bool:
        """Look once more at each chart, now that all others have labels; whether any moved."""
        before = list(self.labels)
        for chart, label in enumerate(before):
            self.mixed[label] -= self.moments[chart]
            taken = {self.labels[other] for other in self.neighbors[chart]}
            kind = self.kinds[chart]
            free = [n for n, k in enumerate(self.palette) if k == kind and n not in taken]
            self.labels[chart] = self._choose(chart, free, label)
        return self.labels != before


def _bits(moments: Float64Array, config: MergingConfig) -> Float64Array:
    """(n,) logarithms of how far UVs are from the affine maps of least squares, for every point."""
    points, diagonal = moments[:, -3, -3], np.arange(moments.shape[1] - 2)
    known = moments[:, :-2, :-2].copy()
    known[:, diagonal, diagonal] += config.ridge
    cross = moments[:, :-2, -2:]
    explained = np.einsum("nij,nij->n", cross, np.linalg.solve(known, cross))
    left = moments[:, -2, -2] + moments[:, -1, -1] - explained
    apart = np.maximum(left, 0) / np.maximum(points, 1) + config.floor**2
    bits: Float64Array = 0.5 * points * np.log2(apart)
    return bits


def _groups(count: int, pairs: IntArray) -> Int32Array:
    """(count,): the same number for all that pairs (t, 2) connect."""
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (count, count))
    labels: Int32Array = connected_components(graph, directed=False)[1]
    return labels


def _neighbors(count: int, points: Float64Array, charts: IntArray, gap: float) -> list[set[int]]:
    """For each of `count` charts, the others that come closer than `gap`.

    Told by cells of that size and their neighbors, so that memory is bounded by the points: some
    charts up to a few times as far apart count as well.
    """
    cells, cell = np.unique(np.floor(points / gap), axis=0, return_inverse=True)
    shape = (len(cells), count)
    there = coo_matrix((np.ones(len(cell), dtype=bool), (cell.reshape(-1), charts)), shape=shape)
    adjacent = (there.T @ (_near_cells(cells) @ there)).tocoo()
    neighbors: list[set[int]] = [set() for _ in range(count)]
    for one, other in zip(adjacent.row.tolist(), adjacent.col.tolist(), strict=True):
        if one != other:
            neighbors[one].add(other)
    return neighbors


def _near_cells(cells: Float64Array) -> coo_matrix:
    """(c, c) bool: cells (c, 3) of integers that touch, themselves included."""
    pairs = cKDTree(cells).query_pairs(1.0, p=np.inf, output_type="ndarray")
    own = np.arange(len(cells))
    rows = np.concatenate([pairs[:, 0], pairs[:, 1], own])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0], own])
    size = (len(cells), len(cells))
    return coo_matrix((np.ones(len(rows), dtype=bool), (rows, columns)), shape=size).tocsr()
