"""Triangulate polygons: fans where they are strictly convex, ear clipping elsewhere."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array

# Ear clipping takes quadratic time or worse; larger polygons than any modeller draws become fans.
MAX_CLIPPED = 4096
# Areas below this share of the whole are rounding.
ROUNDING = 1e-12


def triangulate(points: Float64Array, sizes: Int64Array) -> tuple[Int64Array, Int64Array]:
    """Cut polygons into triangles that keep their orientation.

    points (c, 3): the corners of all polygons, one polygon after the other; sizes (p,): corners of
    each, at least 3. Returns (t, 3) indices into the corners and (t,) the polygon of each triangle,
    ascending. Concave polygons are projected along their Newell normal (Sutherland et al. 1974) and
    cut by ear clipping (Meisters 1975).
    """
    starts = np.cumsum(sizes) - sizes
    triangles, owners = [], []
    for size in np.unique(sizes):
        polygons = np.flatnonzero(sizes == size)
        corners = starts[polygons, None] + np.arange(size)
        with np.errstate(over="ignore", invalid="ignore"):  # absurd sizes are refused later
            cuts = _cut_all(points[corners])
        triangles.append(np.take_along_axis(corners[:, None, :], cuts, axis=2).reshape(-1, 3))
        owners.append(np.repeat(polygons, size - 2))
    if not triangles:
        return np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64)
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    return np.concatenate(triangles)[order], owner[order]


def _cut_all(polygons: Float64Array) -> Int64Array:
    """(g, n, 3) polygons of one size -> (g, n - 2, 3) corners of each one's triangles."""
    count, size, _ = polygons.shape
    steps = np.arange(1, size - 1)
    fan = np.stack([np.zeros_like(steps), steps, steps + 1], axis=1)
    cuts = np.tile(fan, (count, 1, 1))
    if 3 < size <= MAX_CLIPPED:
        for index in np.flatnonzero(~_strictly_convex(polygons)):
            cuts[index] = _clip_ears(_flattened(polygons[index]))
    return cuts


def _newell(polygons: Float64Array) -> Float64Array:
    """(..., n, 3) -> (..., 3): normals whose length is twice the area."""
    centered = polygons - polygons[..., :1, :]
    normal: Float64Array = np.cross(centered, np.roll(centered, -1, axis=-2)).sum(axis=-2)
    return normal


def _strictly_convex(polygons: Float64Array) -> BoolArray:
    """Whether all corners turn the same way, and once around in all."""
    edges = np.roll(polygons, -1, axis=1) - polygons
    turns = np.cross(np.roll(edges, 1, axis=1), edges)
    normal = _newell(polygons)
    sine = np.einsum("gnk,gk->gn", turns, normal)
    cosine = np.einsum("gnk,gnk->gn", np.roll(edges, 1, axis=1), edges)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    turned = np.arctan2(sine, cosine * length).sum(axis=1)
    floor = 1e-9 * length * (edges**2).sum(axis=2).max(axis=1, keepdims=True)
    convex: BoolArray = (sine > floor).all(axis=1) & (turned < 3 * np.pi)
    return convex


def _flattened(polygon: Float64Array) -> Float64Array:
    """(n, 3) -> (n, 2): seen against the normal, so that it runs counter-clockwise."""
    normal = _newell(polygon)
    drop = int(np.abs(normal).argmax())
    axes = [(1, 2), (2, 0), (0, 1)][drop]
    flat = polygon[:, axes] - polygon[0, axes]
    return flat if normal[drop] >= 0 else flat * (-1.0, 1.0)


def _clip_ears(flat: Float64Array) -> Int64Array:
    """Cut ears off a counter-clockwise polygon (n, 2) until a triangle is left: (n - 2, 3)."""
    left = list(range(len(flat)))
    ears = []
    while len(left) > 3:
        at = _find_ear(flat, left)
        ears.append([left[at - 1], left[at], left[(at + 1) % len(left)]])
        del left[at]
    return np.array([*ears, left], dtype=np.int64)


def _find_ear(flat: Float64Array, left: list[int]) -> int:
    """The place in `left` of a corner that can go: its triangle is positive and holds no other.

    What remains must keep an area, or points along an edge would end in a triangle without one.
    A polygon that crosses itself may have no such corner; then its most positive one goes.
    """
    corners = flat[left]
    before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
    areas = _twice_area(before, corners, after)
    total = float(_twice_area(corners[0], corners, after).sum())
    floor = ROUNDING * abs(total)
    blocking = corners[areas <= floor]
    for at in np.argsort(-areas, kind="stable"):
        if areas[at] <= floor:
            break
        keeps_area = total - areas[at] > floor
        if keeps_area and not _holds_any((before[at], corners[at], after[at]), blocking, floor):
            return int(at)
    return int(areas.argmax())


def _holds_any(
    triangle: tuple[Float64Array, Float64Array, Float64Array], points: Float64Array, floor: float
) -> bool:
    """Whether a point other than the corners lies in the triangle or on its border."""
    a, b, c = triangle
    inside = (
        (_twice_area(a, b, points) >= -floor)
        & (_twice_area(b, c, points) >= -floor)
        & (_twice_area(c, a, points) >= -floor)
    )
    corner = (points[:, None] == np.stack(triangle)).all(axis=2).any(axis=1)
    return bool((inside & ~corner).any())


def _twice_area(a: Float64Array, b: Float64Array, c: Float64Array) -> Float64Array:
    u, v = b - a, c - a
    area: Float64Array = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return area
