"""Splitting edges that cross a chart between their ends, before a surface is cut along borders.

A border that runs along an edge may cross it twice, or leave a third chart between its ends. The
ends do not tell, and the cut would leave a patch of the wrong chart there.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SeamConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.newton import onto_surface
from nispcodec.infer.evaluate import classify

# Places along an edge that are asked, the middle first.
SHARES = np.array([0.5, 0.25, 0.75], np.float32)


def with_borders_told(
    sdf: Network, chart: Network, surface: Surface, config: SeamConfig = SeamConfig()
) -> Surface:
    """The surface with a vertex on each edge where a chart of neither end shows, on the zero set.

    Only edges that leave a vertex beside a border are looked at.
    """
    charts = classify(chart, surface.positions)
    for _ in range(config.splits):
        edges, sides, near = _border_edges(surface.faces, charts)
        points, found = _between(chart, surface.positions, edges, charts)
        split = _apart(sides, found)
        if not split.any():
            break
        new = onto_surface(sdf, points[split], surface.cell / 2, steps=1)
        faces = _split(surface.faces, near, sides, split, len(surface.positions))
        surface = Surface(np.vstack([surface.positions, new]), faces, surface.cell)
        charts = np.concatenate([charts, classify(chart, new)])
    return surface


def _border_edges(
    faces: Int32Array, charts: Int32Array
) -> tuple[Int64Array, Int64Array, Int64Array]:
    """Edges (e, 2) with an end beside a border, the sides (k, 3) among them of faces (k,), or -1.

    These faces are all that have such an edge.
    """
    corners = charts[faces]
    beside = np.zeros(len(charts), np.bool_)
    beside[faces[(corners != corners[:, :1]).any(axis=1)]] = True
    near = np.flatnonzero(beside[faces].any(axis=1))
    starts, ends = faces[near], np.roll(faces[near], -1, axis=1)
    asked = beside[starts] | beside[ends]
    keys = np.minimum(starts, ends).astype(np.int64) << 32 | np.maximum(starts, ends)
    unique, inverse = np.unique(keys[asked], return_inverse=True)
    sides = np.full(starts.shape, -1, np.int64)
    sides[asked] = inverse
    return np.column_stack([unique >> 32, unique & 0xFFFFFFFF]), sides, near


def _between(
    chart: Network, positions: Float32Array, edges: Int64Array, charts: Int32Array
) -> tuple[Float32Array, BoolArray]:
    """Where on edges (e, 2) a chart of neither end shows (e, 3), and whether there is such."""
    start, end = positions[edges[:, 0]], positions[edges[:, 1]]
    points = start[:, None] + SHARES[:, None] * (end - start)[:, None]
    shown = classify(chart, points.reshape(-1, 3)).reshape(-1, len(SHARES))
    foreign = (shown[..., None] != charts[edges][:, None]).all(axis=2)
    return points[np.arange(len(edges)), foreign.argmax(axis=1)], foreign.any(axis=1)


def _apart(sides: Int64Array, found: BoolArray) -> BoolArray:
    """Those of the edges `found` (e,) that come first in both faces: no face has two of them."""
    numbers = np.where((sides >= 0) & found[sides], sides, len(found))
    first = (numbers == numbers.min(axis=1, keepdims=True)) & (numbers < len(found))
    wins = np.bincount(numbers[first], minlength=len(found))
    faces = np.bincount(numbers.ravel(), minlength=len(found) + 1)[:-1]
    return found & (wins == faces)


def _split(
    faces: Int32Array, near: Int64Array, sides: Int64Array, split: BoolArray, first: int
) -> Int32Array:
    """The faces, those with a side in `split` (e,) in two; new vertices count from `first`."""
    number = first + np.cumsum(split) - 1
    rows, columns = np.nonzero((sides >= 0) & split[sides])
    new = number[sides[rows, columns]]
    owners = near[rows]
    a, b, c = (faces[owners, (columns + i) % 3] for i in range(3))
    halved = faces.copy()
    halved[owners] = np.column_stack([a, new, c])
    return np.vstack([halved, np.column_stack([new, b, c])]).astype(np.int32)
