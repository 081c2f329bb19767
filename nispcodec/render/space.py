"""A bounding shape for a fitted field: where its surface cannot be, known without its network.

Cells of a grid over the cube of the normalized frame are halved where the field says that its
surface may pass, and the field is remembered at the corners of those that are left. Between them
it is interpolated, with a doubt measured in the middle of every cell, and elsewhere the distance to
such cells stands for it. What is recognized as noise of the field is no surface at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float32Array, Int64Array
from nispcodec.core.network import Network
from nispcodec.extract.grid import CUBE
from nispcodec.extract.isosurface import BALL, extract
from nispcodec.infer.evaluate import evaluate, gradient

COARSE, HALVINGS = 32, 2
SOME = 4096
HALVES = np.indices((2, 2, 2)).reshape(3, -1).T
# Interpolation may be off elsewhere in a cell by this many times what it is off in the middle.
CAUTION, LEAST_DOUBT = 2.0, 5e-4


@dataclass(frozen=True)
class Space:
    """Bounds of a field over the cube [-CUBE, CUBE]^3: how far its surface is at least, signed.

    Distances are negative inside. `above` and `below` are (r, r, r) float32, for the points of a
    grid and to be interpolated; `cells` (r - 1, r - 1, r - 1) float32, for all points of a cell.

    above  the distance or less, wherever that is positive
    below  the distance or more, wherever that is negative
    cells  0 near the surface; elsewhere the distance, or nearer to 0
    slope  how fast the field may change near the surface: it is a distance when divided by this
    """

    above: Float32Array
    below: Float32Array
    cells: Float32Array
    slope: float

    def free(self, points: Float32Array) -> Float32Array:
        """(n,): no surface is nearer than this to points (n, 3); negative inside; 0 if unknown."""
        count = len(self.cells)
        place = (points.T + np.float32(CUBE)) * np.float32(count / (2 * CUBE))
        x, y, z = np.clip(place, 0, count - 1).astype(np.int32)
        free: Float32Array = self.cells.take((x * count + y) * count + z)
        near = np.flatnonzero(np.abs(free) < 2 * CUBE / count)
        if len(near):
            free[near] = self._interpolated(place.take(near, axis=1))
        return free

    def _interpolated(self, place: Float32Array) -> Float32Array:
        free = np.maximum(_between(self.above, place), 0)
        within = np.flatnonzero(free == 0)
        if len(within):
            free[within] = np.minimum(_between(self.below, place.take(within, axis=1)), 0)
        return free


def _between(grid: Float32Array, place: Float32Array) -> Float32Array:
    from scipy.ndimage import map_coordinates

    values: Float32Array = map_coordinates(grid, place, output=np.float32, order=1, mode="nearest")
    return values


def bounding_space(network: Network, half_thickness: float = 0.0) -> Space:
    """Bounds, found beforehand, on where the surface of an SDF network may be.

    `half_thickness` is the document's, normalized frame. Noise is recognized on the mesh of a plain
    decode: on coarser ones thin parts break into pieces that look like noise.
    """
    cells, count = np.indices((COARSE,) * 3).reshape(3, -1).T, COARSE
    middles, cells = _crossed(network, cells, count)
    for _ in range(HALVINGS):
        count *= 2
        middles, cells = _crossed(network, (2 * cells[:, None] + HALVES).reshape(-1, 3), count)
    real = _is_surface(network, half_thickness, cells, count)
    return _remembered(network, cells[real], middles[real], count)


def _remembered(network: Network, cells: Int64Array, middles: Float32Array, count: int) -> Space:
    """The field at the corners of cells that may hold surface, and distances from them."""
    slope = _slope(network, _centers(cells, count))
    shape = (count + 1,) * 3
    corners = np.ravel_multi_index(tuple((cells[:, None] + HALVES).T), shape).T
    used, inverse = np.unique(corners, return_inverse=True)
    points = np.stack(np.unravel_index(used, shape), axis=1) * (2 * CUBE / count) - CUBE
    field = evaluate(network, points.astype(np.float32))[:, 0]
    off = np.abs(field[inverse].reshape(corners.shape).mean(axis=1) - middles)
    doubt = np.zeros(shape, np.float32)
    np.maximum.at(doubt.ravel(), corners, (CAUTION * off + LEAST_DOUBT)[:, None])
    doubt /= np.float32(slope)
    values = np.zeros(shape, np.float32)
    values.ravel()[used] = field / slope
    distances, sides = _from_known(doubt > 0, values)
    # Between points of the grid the distance may be less than interpolated, by half the diagonal.
    empty = sides * np.maximum(distances - np.float32(np.sqrt(3) * CUBE / count), 0)
    values = np.where(doubt > 0, values, empty)
    bounds = sides[:-1, :-1, :-1] * _least_of_cells(distances)
    return Space(values - doubt, values + doubt, bounds, slope)


def _from_known(known: BoolArray, values: Float32Array) -> tuple[Float32Array, Float32Array]:
    """How far points of the grid are from the nearest that is known, and on which side: 1 or -1.

    There is no surface in between, so that both are on the same side of it.
    """
    from scipy.ndimage import distance_transform_edt

    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    away = np.zeros(known.shape, np.float32)
    for there, here in zip(nearest, np.ogrid[tuple(map(slice, known.shape))], strict=True):
        away += (there - here) ** 2
    distances = np.sqrt(away) * np.float32(2 * CUBE / (len(known) - 1))
    return distances, np.where(values[tuple(nearest)] < 0, np.float32(-1), np.float32(1))


def _least_of_cells(values: Float32Array) -> Float32Array:
    """The least value at the eight corners of each cell."""
    values = np.minimum(values[1:], values[:-1])
    values = np.minimum(values[:, 1:], values[:, :-1])
    return np.minimum(values[:, :, 1:], values[:, :, :-1])


def _crossed(network: Network, cells: Int64Array, count: int) -> tuple[Float32Array, Int64Array]:
    """Those cells, of `count` along an edge, that the surface may cross; the field in them."""
    centers = _centers(cells, count)
    field = evaluate(network, centers)[:, 0]
    near = np.abs(field) <= _slope(network, centers) * np.sqrt(3) * CUBE / count
    return field[near], cells[near]


def _slope(network: Network, points: Float32Array) -> float:
    """A bound on the field's slope around the points: 1 for an SDF, for a fitted one nearly."""
    some = points[:: 1 + len(points) // SOME]
    slopes = np.linalg.norm(gradient(network, some)[1], axis=1)
    return float(1.1 * np.percentile(slopes, 99)) if len(slopes) else 1.0


def _is_surface(
    network: Network, half_thickness: float, cells: Int64Array, count: int
) -> BoolArray:
    """Which cells are inside the unit ball and hold no surface that is recognized as noise."""
    from scipy.ndimage import label

    centers = _centers(cells, count)
    reach = 2 * CUBE / count
    inside: BoolArray = np.linalg.norm(centers, axis=1) < BALL + reach
    marked = np.zeros((count,) * 3, np.bool_)
    marked[tuple(cells[inside].T)] = True
    if label(marked, np.ones((3, 3, 3)))[1] < 2:
        return inside
    # Slow to import, and seldom needed.
    from scipy.spatial import KDTree

    from nispcodec.extract.components import spurious
    from nispcodec.extract.meshing import default_resolution

    surface = extract(network, default_resolution(network, half_thickness))
    unwanted, labels = spurious(network, surface)
    if not unwanted.any():
        return inside
    distances, nearest = KDTree(surface.positions).query(centers)
    return inside & (~unwanted[labels[nearest]] | (distances > 2 * reach))


def _centers(cells: Int64Array, count: int) -> Float32Array:
    return ((cells + 0.5) * (2 * CUBE / count) - CUBE).astype(np.float32)
