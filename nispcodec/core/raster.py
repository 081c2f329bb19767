"""Rasterization of an atlas: which texels its faces cover, and colors for the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Float64Array, Int32Array, Uint8Array

CANDIDATES = 1 << 21


@dataclass(frozen=True)
class Texels:
    """Texels that a face covers: row, column and face (n,), barycentric weights (n, 3)."""

    rows: Int32Array
    columns: Int32Array
    faces: Int32Array
    weights: Float64Array


def texels(corner_uvs: Float64Array, height: int, width: int) -> Texels:
    """Every texel of an image whose center a face covers; the last face where several do.

    corner_uvs (m, 3, 2): UVs of every face's corners, origin bottom-left, within [0, 1]. The image
    has its top row first.
    """
    owners = np.full((height, width), -1, np.int32)
    weights = np.zeros((height, width, 3))
    for rows, columns, faces, shares in _covered(corner_uvs, height, width):
        owners[rows, columns] = faces
        weights[rows, columns] = shares
    rows, columns = (where.astype(np.int32) for where in np.nonzero(owners >= 0))
    return Texels(rows, columns, owners[rows, columns], weights[rows, columns])


def coverage(corner_uvs: Float64Array, height: int, width: int) -> BoolArray:
    """(height, width) bool: which texels' centers a face covers; corner_uvs as in `texels`."""
    covered = np.zeros((height, width), np.bool_)
    for rows, columns, _, _ in _covered(corner_uvs, height, width):
        covered[rows, columns] = True
    return covered


def padded(image: Uint8Array, covered: BoolArray) -> Uint8Array:
    """The image (h, w, c) with the nearest covered texel's color where `covered` (h, w) is False.

    The image itself where nothing is covered.
    """
    from scipy.ndimage import distance_transform_edt

    if not covered.any():
        return image
    nearest = distance_transform_edt(~covered, return_distances=False, return_indices=True)
    return np.ascontiguousarray(image[tuple(nearest)])


def padded_smoothly(image: Uint8Array, covered: BoolArray) -> Uint8Array:
    """The image (h, w, c) with smooth colors where `covered` (h, w) is False.

    They are means of larger squares the farther the covered texels are: pull-push (Gortler et al.
    1996, The Lumigraph). The image itself where nothing is covered.
    """
    if not covered.any():
        return image
    return np.rint(_filled(image.astype(np.float32), covered)).astype(np.uint8)


def _filled(colors: Float32Array, covered: BoolArray) -> Float32Array:
    """Colors (h, w, c) with those of the image of half the size where `covered` is False."""
    from PIL.Image import Resampling, fromarray

    if covered.all():
        return colors
    coarse = np.moveaxis(_filled(*_halved(colors, covered)), 2, 0)
    size = covered.shape[::-1]
    finer = [np.asarray(fromarray(each).resize(size, Resampling.BILINEAR)) for each in coarse]
    return np.where(covered[..., None], colors, np.stack(finer, axis=2))


def _halved(colors: Float32Array, covered: BoolArray) -> tuple[Float32Array, BoolArray]:
    """Means of the covered texels of each two by two, and where there are any."""
    height, width = (-(-size // 2) for size in covered.shape)
    odd = [(0, 2 * height - len(covered)), (0, 2 * width - covered.shape[1])]
    counted = np.dstack([colors * covered[..., None], covered.astype(np.float32)])
    squares = np.pad(counted, [*odd, (0, 0)]).reshape(height, 2, width, 2, -1)
    sums = squares.sum(axis=(1, 3))
    return sums[..., :-1] / np.maximum(sums[..., -1:], 1), sums[..., -1] > 0


def _covered(
    corner_uvs: Float64Array, height: int, width: int
) -> Iterator[tuple[Int32Array, Int32Array, Int32Array, Float64Array]]:
    """Texels inside of faces: rows, columns, faces (n,), barycentric weights (n, 3)."""
    pixels: Float64Array = corner_uvs * [width, -height] + [0.0, height]
    for faces, x, y in _candidates(pixels, height, width):
        shares = _barycentric(pixels[faces], np.column_stack([x + 0.5, y + 0.5]))
        inside = (shares >= -1e-9).all(axis=1)
        yield y[inside], x[inside], faces[inside], shares[inside]


def _candidates(
    pixels: Float64Array, height: int, width: int
) -> Iterator[tuple[Int32Array, Int32Array, Int32Array]]:
    """Faces with the texels of their bounding boxes (face, x, y), some millions at a time."""
    last = [width - 1, height - 1]
    low = np.clip(np.floor(pixels.min(axis=1)), 0, last).astype(np.int32)
    high = np.clip(np.floor(pixels.max(axis=1)), 0, last).astype(np.int32)
    spans = high - low + 1
    counts = spans.prod(axis=1, dtype=np.int64)
    bins = (np.cumsum(counts) - 1) // CANDIDATES
    for part in np.split(np.arange(len(counts)), np.flatnonzero(np.diff(bins)) + 1):
        faces = np.repeat(part, counts[part])
        within = np.arange(len(faces)) - np.repeat(
            np.cumsum(counts[part]) - counts[part], counts[part]
        )
        x, y = low[faces, 0] + within % spans[faces, 0], low[faces, 1] + within // spans[faces, 0]
        yield faces.astype(np.int32), x.astype(np.int32), y.astype(np.int32)


def _barycentric(triangles: Float64Array, points: Float64Array) -> Float64Array:
    """Weights (n, 3) of points (n, 2) in triangles (n, 3, 2); -1 in triangles without area."""
    a, b, c = triangles.transpose(1, 0, 2)
    u, v, w = b - a, c - a, points - a
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    second = np.full(len(points), -1.0)
    third = np.full(len(points), -1.0)
    np.divide(w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0], area, out=second, where=area != 0)
    np.divide(u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0], area, out=third, where=area != 0)
    return np.column_stack([1 - second - third, second, third])
