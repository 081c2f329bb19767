"""What a point is to a triangle: how far its closest point is, and how large it looks.

A triangle is a column of ROWS numbers, so that many are computed at a time. Whatever two triangles
share, a corner or an edge, gives both the same distance to the last bit: which of them a search
finds first can then be decided by their numbers.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array

ROWS = 18
"""Corners a, b, c (9); for the edges ab, bc, ca 1 over the square of half the length, 0 for an edge
without length (3); vectors v and w (6): a point's weights of b and c in the triangle's plane are v
and w times its way from a; both 0 for a triangle without area."""


def triangle_rows(corners: Float64Array) -> Float64Array:
    """(ROWS, f) for triangles (f, 3, 3)."""
    a, b, c = corners[:, 0].T, corners[:, 1].T, corners[:, 2].T
    halves = [(end - start) * 0.5 for start, end in ((a, b), (b, c), (c, a))]
    inverse = [_inverse(dot(half, half)) for half in halves]
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
    """Of vectors along the first axis, (3, ...); summed in the order that the kernel has too."""
    product: Float64Array = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def squared_distances(rows: Float64Array, points: Float64Array) -> Float64Array:
    """(...) squared distances of points (3, ...) from triangles (ROWS, ...)."""
    a, b, c = rows[0:3], rows[3:6], rows[6:9]
    best = np.minimum(
        np.minimum(_to_edge(points, a, b, rows[9])[0], _to_edge(points, b, c, rows[10])[0]),
        _to_edge(points, c, a, rows[11])[0],
    )
    over, squared, _, _ = _to_inside(points, rows)
    return np.where(over, np.minimum(best, squared), best)


def closest_weights(rows: Float64Array, points: Float64Array) -> Float64Array:
    """(3, n) weights of the corners at the closest points to points (3, n) of triangles."""
    a, b, c = rows[0:3], rows[3:6], rows[6:9]
    edges = [
        _to_edge(points, start, end, rows[9 + number])
        for number, (start, end) in enumerate(((a, b), (b, c), (c, a)))
    ]
    weights = np.zeros((3, points.shape[1]))
    weights[0] = 1
    best = np.full(points.shape[1], np.inf)
    for number, (squared, along) in enumerate(edges):
        less = squared < best
        best[less] = squared[less]
        weights[:, less] = 0
        weights[number, less] = (1 - along[less]) * 0.5
        weights[(number + 1) % 3, less] = (1 + along[less]) * 0.5
    over, squared, v, w = _to_inside(points, rows)
    less = over & (squared < best)
    weights[:, less] = np.stack([1 - v - w, v, w])[:, less]
    return weights


def _to_edge(
    points: Float64Array, start: Float64Array, end: Float64Array, inverse: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Squared distance from an edge, and where on it: -1 at its start to 1 at its end.

    From the middle, so that it does not matter which end is the start.
    """
    middle, half = (start + end) * 0.5, (end - start) * 0.5
    along = dot(points - middle, half) * inverse
    along = np.minimum(np.maximum(along, -1), 1)
    closest = middle + along * half
    closest = np.where(along >= 1, end, np.where(along <= -1, start, closest))
    off = points - closest
    return dot(off, off), along


def _to_inside(
    points: Float64Array, rows: Float64Array
) -> tuple[BoolArray, Float64Array, Float64Array, Float64Array]:
    """Whether points are over the inside of triangles; if so the squared distance and weights.

    It is the distance from a point of the triangle even where rounding has made the weights wrong.
    """
    a, ab, ac = rows[0:3], rows[3:6] - rows[0:3], rows[6:9] - rows[0:3]
    way = points - a
    v, w = dot(way, rows[12:15]), dot(way, rows[15:18])
    off = way - v * ab - w * ac
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
