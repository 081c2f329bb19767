"""Cutting a surface along the borders between charts, so that every triangle lies in one chart.

Every edge whose ends lie on different charts gets one new vertex where the chart field changes;
both triangles at the edge use it, so the cut leaves no crack and no T-junction.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SeamConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.newton import onto_surface
from nispcodec.infer.evaluate import contrast


def cut_along_seams(
    sdf: Network,
    chart: Network,
    surface: Surface,
    charts: Int32Array,
    config: SeamConfig = SeamConfig(),
) -> tuple[Surface, Int32Array]:
    """The surface cut where `charts` (n,), one a vertex, change -> surface, chart of each face."""
    corners = charts[surface.faces]
    crossing = corners != np.roll(corners, -1, axis=1)
    edges, cuts = _crossed_edges(surface.faces, crossing, len(surface.positions))
    borders = _borders(chart, surface.positions, edges, charts, config)
    new = onto_surface(sdf, borders, surface.cell / 2, steps=1)
    positions = np.vstack([surface.positions, new])
    kinds = crossing.sum(axis=1)
    middles = _middles(sdf, positions, cuts[kinds == 3], surface.cell)
    in_two = _cut_in_two(
        positions, surface.faces[kinds == 2], corners[kinds == 2], cuts[kinds == 2]
    )
    in_three = _cut_in_three(
        surface.faces[kinds == 3], corners[kinds == 3], cuts[kinds == 3], len(positions)
    )
    parts = [(surface.faces[kinds == 0], corners[kinds == 0, 0]), in_two, in_three]
    faces = np.vstack([part[0] for part in parts]).astype(np.int32)
    face_charts = np.concatenate([part[1] for part in parts])
    return Surface(np.vstack([positions, middles]), faces, surface.cell), face_charts


def _crossed_edges(
    faces: Int32Array, crossing: BoolArray, first: int
) -> tuple[Int64Array, Int32Array]:
    """Crossed edges (e, 2) and, for each side of each face, its cut's vertex number or -1."""
    following = np.roll(faces, -1, axis=1)
    low, high = np.minimum(faces, following), np.maximum(faces, following)
    keys = low.astype(np.int64) << 32 | high
    unique, inverse = np.unique(keys[crossing], return_inverse=True)
    cuts = np.full(faces.shape, -1, np.int32)
    cuts[crossing] = first + inverse
    return np.column_stack([unique >> 32, unique & 0xFFFFFFFF]), cuts


def _borders(
    network: Network,
    positions: Float32Array,
    edges: Int64Array,
    charts: Int32Array,
    config: SeamConfig,
) -> Float32Array:
    """Where the chart changes along each edge: (e, 3), by bisection on the two charts' contrast."""
    start, end = positions[edges[:, 0]], positions[edges[:, 1]]
    first, second = charts[edges[:, 0]], charts[edges[:, 1]]
    low, high = np.zeros(len(edges), np.float32), np.ones(len(edges), np.float32)
    # Where a vote overruled the field at an end there is nothing to bisect: cut in the middle.
    bracketed = (contrast(network, start, first, second) >= 0) & (
        contrast(network, end, first, second) <= 0
    )
    for _ in range(config.bisections):
        middle = (low + high) / 2
        points = start + middle[:, None] * (end - start)
        before = contrast(network, points, first, second) > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    share = np.where(bracketed, (low + high) / 2, np.float32(0.5))
    share = np.clip(share, config.clearance, 1 - config.clearance)
    borders: Float32Array = start + share[:, None] * (end - start)
    return borders


def _middles(sdf: Network, positions: Float32Array, cuts: Int32Array, cell: float) -> Float32Array:
    centers = positions[cuts].mean(axis=1, dtype=np.float32)
    return onto_surface(sdf, centers, cell / 2, steps=1)


def _cut_in_two(
    positions: Float32Array, faces: Int32Array, corners: Int32Array, cuts: Int32Array
) -> tuple[Int32Array, Int32Array]:
    """Two corners on one chart: a triangle at the lone corner, a quad at the others."""
    lone = np.argmin(cuts, axis=1) - 1
    order = (lone[:, None] + np.arange(3)) % 3
    rows = np.arange(len(faces))[:, None]
    (p, q, r), (a, b, _) = faces[rows, order].T, corners[rows, order].T
    after, before = cuts[rows, order].T[[0, 2]]
    one = np.linalg.norm(positions[after] - positions[r], axis=1)
    other = np.linalg.norm(positions[before] - positions[q], axis=1)
    # The quad is split along its shorter diagonal.
    flip = other < one
    triangles = [
        np.column_stack([p, after, before]),
        np.column_stack([after, q, np.where(flip, before, r)]),
        np.column_stack([before, np.where(flip, q, after), r]),
    ]
    return np.vstack(triangles), np.concatenate([a, b, b])


def _cut_in_three(
    faces: Int32Array, corners: Int32Array, cuts: Int32Array, first: int
) -> tuple[Int32Array, Int32Array]:
    """Three charts: a quad at each corner, all meeting in a new vertex in the middle."""
    middle = first + np.arange(len(faces), dtype=np.int32)
    triangles, charts = [], []
    for i in range(3):
        corner, after, before = faces[:, i], cuts[:, i], cuts[:, i - 1]
        triangles.append(np.column_stack([corner, after, middle]))
        triangles.append(np.column_stack([corner, middle, before]))
        charts += [corners[:, i]] * 2
    return np.vstack(triangles), np.concatenate(charts)
