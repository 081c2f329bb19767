"""Which charts share a number: mirror images, and charts far apart whose UVs go together.

A position tells such charts apart already, so the networks need a number only to keep neighbours
apart: some hundred charts become a few dozen labels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from nispcodec.asset import FloatArray
from nispcodec.mesh.charts import Charts, colored

RIDGE = 1e-4
"""Keeps the direction across a flat chart, of which nothing is known, from deciding anything."""


@dataclass(frozen=True)
class Cover:
    """n points on the visible surface, of every chart some: all that merging looks at.

    points       (n, 3) normalised frame
    charts       (n,) before merging
    coordinates  (n, d) as the UV network sees the points: of mirrored axes the absolute value
    uvs          (n, 2)
    """

    points: FloatArray
    charts: NDArray[np.integer]
    coordinates: FloatArray
    uvs: FloatArray


def merge_charts(charts: Charts, cover: Cover, twins: NDArray[np.integer], gap: float) -> Charts:
    """Give one number to charts of one material: twins, and those further apart than `gap`.

    twins (t, 2): pairs of charts whose UVs are the same function of `coordinates`, near or far.
    Of all charts that could share a number those do whose UVs are most nearly one affine map of the
    coordinates: the least is left to learn for the UV network.
    """
    alike = (charts.materials[twins] == charts.materials[twins[:, :1]]).all(axis=1)
    group = _groups(len(charts), twins[alike])
    count = int(group.max()) + 1
    first = np.unique(group, return_index=True)[1]
    kinds = [(int(charts.materials[i]), bool(charts.has_uv[i])) for i in first]
    numbers = group[cover.charts]
    neighbours = _neighbours(count, cover.points, numbers, gap)
    _, palette = colored(neighbours, kinds)  # as few labels as the first that is free would take
    fits = _Fits(count, cover, numbers)
    labels, palette = colored(neighbours, kinds, palette, fits.choose)
    return Charts(
        np.asarray(labels, dtype=np.int32)[group][charts.face_charts],
        np.asarray([material for material, _ in palette], dtype=np.int32),
        np.asarray([has_uv for _, has_uv in palette], dtype=bool),
    )


class _Fits:
    """How far the UVs of some charts are from one affine map: moments of charts add up."""

    def __init__(self, count: int, cover: Cover, numbers: NDArray[np.integer]) -> None:
        ones = np.ones((len(numbers), 1))
        rows = np.hstack([cover.coordinates, ones, cover.uvs])
        self.size = rows.shape[1]
        products = (rows[:, :, None] * rows[:, None, :]).reshape(len(rows), -1)
        member = coo_matrix((ones[:, 0], (numbers, np.arange(len(rows)))), (count, len(rows)))
        self.moments = (member @ products).reshape(count, self.size, self.size)
        self.mixed = np.zeros((2 * count, self.size, self.size))
        self.left = np.zeros(2 * count)

    def choose(self, chart: int, colors: Sequence[int]) -> int:
        """The colour whose UVs fit worse by the least with this chart, which is added to it."""
        together = self.mixed[colors] + self.moments[chart]
        left = self._left(together)
        best = int(np.argmin(left - self.left[colors]))
        color = colors[best]
        self.mixed[color], self.left[color] = together[best], left[best]
        return color

    def _left(self, moments: FloatArray) -> FloatArray:
        """Sums of squares (n,) that least squares leaves, by moments (n, size, size)."""
        known = moments[:, :-2, :-2] + RIDGE * np.eye(self.size - 2)
        cross = moments[:, :-2, -2:]
        explained = np.einsum("nij,nij->n", cross, np.linalg.solve(known, cross))
        left: FloatArray = np.trace(moments[:, -2:, -2:], axis1=1, axis2=2) - explained
        return left


def _groups(count: int, pairs: NDArray[np.integer]) -> NDArray[np.int32]:
    """(count,): the same number for all that pairs (t, 2) connect."""
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (count, count))
    labels: NDArray[np.int32] = connected_components(graph, directed=False)[1]
    return labels


def _neighbours(
    count: int, points: FloatArray, charts: NDArray[np.integer], gap: float
) -> list[set[int]]:
    """For each of `count` charts, the others that come closer than `gap`.

    Told by cells of that size and their neighbours, so that memory is bounded by the points: some
    charts up to a few times as far apart count as well.
    """
    cells, cell = np.unique(np.floor(points / gap), axis=0, return_inverse=True)
    shape = (len(cells), count)
    there = coo_matrix((np.ones(len(cell), dtype=bool), (cell.reshape(-1), charts)), shape=shape)
    adjacent = (there.T @ (_near_cells(cells) @ there)).tocoo()
    neighbours: list[set[int]] = [set() for _ in range(count)]
    for one, other in zip(adjacent.row.tolist(), adjacent.col.tolist(), strict=True):
        if one != other:
            neighbours[one].add(other)
    return neighbours


def _near_cells(cells: FloatArray) -> coo_matrix:
    """(c, c) bool: cells (c, 3) of integers that touch, themselves included."""
    pairs = cKDTree(cells).query_pairs(1.0, p=np.inf, output_type="ndarray")
    own = np.arange(len(cells))
    rows = np.concatenate([pairs[:, 0], pairs[:, 1], own])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0], own])
    size = (len(cells), len(cells))
    return coo_matrix((np.ones(len(rows), dtype=bool), (rows, columns)), shape=size).tocsr()
