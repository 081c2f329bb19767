"""A bounding shape for a fitted field: where its surface cannot be, known without its network.

Cells of a grid over the cube of the normalised frame are halved where the field says that its
surface may pass, and the field is remembered at the corners of those that are left. Between them
it is interpolated, with a doubt measured in the middle of every cell, and elsewhere the distance to
such cells stands for it. What is recognised as noise of the field is no surface at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label, map_coordinates
from scipy.spatial import KDTree

from nispcodec.decode.components import OUTSIDE, spurious
from nispcodec.decode.evaluate import evaluate, gradient
from nispcodec.decode.extract import LIMIT, extract
from nispcodec.network import Network
from nispcodec.render.fragments import Floats, Indices

COARSE, HALVINGS = 32, 2
# Noise is looked for on a surface of this resolution.
NOISE_RESOLUTION = 96
SOME = 4096
HALVES = np.indices((2, 2, 2)).reshape(3, -1).T
# Interpolation may be off elsewhere in a cell by this many times what it is off in the middle.
CAUTION, LEAST_DOUBT = 2.0, 5e-4


@dataclass(frozen=True)
class Space:
    """What is known of a field on a grid of (r, r, r) points over the cube [-1.02, 1.02]^3.

    values  float32: distance to the surface, or less
    doubt   float32: how far interpolated values may be off
    slope   how fast the field may change near the surface: it is a distance when divided by this
    """

    values: Floats
    doubt: Floats
    slope: float

    def free(self, points: Floats) -> Floats:
        """(n,): no surface is nearer than this to points (n, 3); 0 or less where that is open."""
        place = (points.T + np.float32(LIMIT)) * np.float32((len(self.values) - 1) / (2 * LIMIT))
        value, doubt = (
            map_coordinates(grid, place, output=np.float32, order=1, mode="nearest")
            for grid in (self.values, self.doubt)
        )
        free: Floats = np.abs(value) - doubt
        return free


def bounding_space(network: Network) -> Space:
    """What can be known beforehand of where the surface of an SDF network is not."""
    cells, count = np.indices((COARSE,) * 3).reshape(3, -1).T, COARSE
    middles, cells = _crossed(network, cells, count)
    for _ in range(HALVINGS):
        count *= 2
        middles, cells = _crossed(network, (2 * cells[:, None] + HALVES).reshape(-1, 3), count)
    real = _is_surface(network, cells, count)
    return _remembered(network, cells[real], middles[real], count)


def _remembered(network: Network, cells: Indices, middles: Floats, count: int) -> Space:
    """The field at the corners of cells that may hold surface, and distances from them."""
    slope = _slope(network, _centres(cells, count))
    shape = (count + 1,) * 3
    corners = np.ravel_multi_index(tuple((cells[:, None] + HALVES).T), shape).T
    used, inverse = np.unique(corners, return_inverse=True)
    points = np.stack(np.unravel_index(used, shape), axis=1) * (2 * LIMIT / count) - LIMIT
    field = evaluate(network, points.astype(np.float32))[:, 0]
    off = np.abs(field[inverse].reshape(corners.shape).mean(axis=1) - middles)
    values, doubt = np.ones(shape, np.float32), np.zeros(shape, np.float32)
    values.ravel()[used] = 0
    # Surface is within half a cell's diagonal of such a corner.
    values = (distance_transform_edt(values) - np.sqrt(3) / 2) * 2 * LIMIT / count
    np.maximum.at(doubt.ravel(), corners, (CAUTION * off + LEAST_DOUBT)[:, None])
    values.ravel()[used] = field / slope
    return Space(values.astype(np.float32), doubt / np.float32(slope), slope)


def _crossed(network: Network, cells: Indices, count: int) -> tuple[Floats, Indices]:
    """Those cells, of `count` along an edge, that the surface may cross; the field in them."""
    centres = _centres(cells, count)
    field = evaluate(network, centres)[:, 0]
    near = np.abs(field) <= _slope(network, centres) * np.sqrt(3) * LIMIT / count
    return field[near], cells[near]


def _slope(network: Network, points: Floats) -> float:
    """A bound on the field's slope around the points: 1 for an SDF, for a fitted one nearly."""
    some = points[:: 1 + len(points) // SOME]
    slopes = np.linalg.norm(gradient(network, some)[1], axis=1)
    return float(1.1 * np.percentile(slopes, 99)) if len(slopes) else 1.0


def _is_surface(network: Network, cells: Indices, count: int) -> NDArray[np.bool_]:
    """Which cells are inside the unit ball and hold no surface that is recognised as noise."""
    centres = _centres(cells, count)
    reach = 2 * LIMIT / count
    inside: NDArray[np.bool_] = np.linalg.norm(centres, axis=1) < OUTSIDE + reach
    marked = np.zeros((count,) * 3, np.bool_)
    marked[tuple(cells[inside].T)] = True
    if label(marked, np.ones((3, 3, 3)))[1] < 2:
        return inside
    surface = extract(network, NOISE_RESOLUTION)
    unwanted, labels = spurious(network, surface)
    if not unwanted.any():
        return inside
    distances, nearest = KDTree(surface.positions).query(centres)
    return inside & (~unwanted[labels[nearest]] | (distances > 2 * reach))


def _centres(cells: Indices, count: int) -> Floats:
    return ((cells + 0.5) * (2 * LIMIT / count) - LIMIT).astype(np.float32)
