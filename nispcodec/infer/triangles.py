"""A triangle as seen from a point: where it is closest, how far that is, how large it looks.

A triangle is a column of ROWS numbers, so that many are computed at a time. Whatever two triangles
share, a corner or an edge, gives both the same distance to the last bit: which of them a search
finds first can then be decided by their numbers.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array

ROWS = 18
"""Corners a, b, c (9); for the edges ab, bc, ca 1 over the square of the length, 0 for an edge
without length (3); vectors v and w (6): a point's weights of b and c in the triangle's plane are v
and w times its way from a; both 0 for a triangle without area."""


def triangle_rows(corners: Float64Array) -> Float64Array:
    """(ROWS, f) for triangles (f, 3, 3)."""
    a, b, c = corners[:, 0].T, corners[:, 1].T, corners[:, 2].T
    edges = [end - start for start, end in ((a, b), (b, c), (c, a))]
    inverse = [_inverse(dot(edge, edge)) for edge in edges]
    ab, ac = b - a, c - a
    bb, bc, cc = dot(ab, ab), dot(ab, ac), dot(ac, ac)
    scale = _inverse(bb * cc - bc * bc)
    return np.vstack([a, b, c, inverse, (cc * ab - bc * ac) * scale, (bb * ac - bc * ab) * scale])


def _inverse(values: Float64Array) -> Float64Array:
    """1 over each, or 0 where that is no finite number above 0."""
    with np.errstate(divide="ignore", over="ignore"):
        inverse = 1 / values
    inverse[~((values > 0) & np.isfinite(inverse))] = 0
    return inverse


def dot(a: Float64Array, b: Float64Array) -> Float64Array:
    """Product of vectors along the first axis, (3, ...); summed in the order of the kernel."""
    product: Float64Array = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def squared_distances(rows: Float64Array, points: Float64Array) -> Float64Array:
    """(...) squared distances of points (3, ...) from triangles (ROWS, ...)."""
    edges = [squared for squared, _ in _to_edges(rows, points)]
    best = np.minimum(np.minimum(edges[0], edges[1]), edges[2])
    over, squared, _, _ = _to_inside(rows, points)
    return np.where(over, np.minimum(best, squared), best)


def closest_weights(rows: Float64Array, points: Float64Array) -> Float64Array:
    """(3, n) weights of the corners at the closest points to points (3, n) of triangles."""
    weights = np.zeros((3, points.shape[1]))
    best = np.full(points.shape[1], np.inf)
    for number, (squared, along) in enumerate(_to_edges(rows, points)):
        less = squared < best
        best[less] = squared[less]
        weights[:, less] = 0
        weights[number, less] = (1 - along[less]) * 0.5
        weights[(number + 1) % 3, less] = (1 + along[less]) * 0.5
    over, squared, v, w = _to_inside(rows, points)
    less = over & (squared < best)
    weights[:, less] = np.stack([1 - v - w, v, w])[:, less]
    return weights


def _to_edges(
    rows: Float64Array, points: Float64Array
) -> Iterator[tuple[Float64Array, Float64Array]]:
    """Squared distances from the three edges, and where on them: -1 at the start to 1 at the end.

    From an edge's middle, so that it does not matter which end is the start.
    """
    ways = rows[0:3] - points, rows[3:6] - points, rows[6:9] - points
    corners = [dot(way, way) for way in ways]
    for number in range(3):
        following = (number + 1) % 3
        both, edge = ways[number] + ways[following], ways[following] - ways[number]
        along = np.minimum(np.maximum(-(dot(both, edge) * rows[9 + number]), -1), 1)
        off = both + edge * along
        squared = dot(off, off) * 0.25
        squared = np.where(along <= -1, corners[number], squared)
        yield np.where(along >= 1, corners[following], squared), along


def _to_inside(
    rows: Float64Array, points: Float64Array
) -> tuple[BoolArray, Float64Array, Float64Array, Float64Array]:
    """Whether points are over the inside of triangles; if so the squared distance and weights.

    It is the distance from a point of the triangle even where rounding has made the weights wrong.
    """
    a, b, c = rows[0:3] - points, rows[3:6] - points, rows[6:9] - points
    v, w = -dot(a, rows[12:15]), -dot(a, rows[15:18])
    off = a + (b - a) * v + (c - a) * w
    return (v > 0) & (w > 0) & (v + w < 1), dot(off, off), v, w


def solid_angles(rows: Float64Array, points: Float64Array) -> Float64Array:
    """(...) signed angles that triangles (9 rows or more, ...) fill, seen from points (3, ...).

    4 pi all around; 0 from a point in the triangle's plane. Van Oosterom and Strackee 1983.
    """
    a, b, c = rows[0:3] - points, rows[3:6] - points, rows[6:9] - points
    volume = (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
    la, lb, lc = (np.sqrt(dot(each, each)) for each in (a, b, c))
    rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return np.where(volume == 0, 0, 2 * np.arctan2(volume, rest))
