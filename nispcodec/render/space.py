"""A bounding shape for a fitted field: where its surface may be, and how far away that is.

Cells of a grid over the cube of the normalised frame, halved where the field says that its surface
may pass. Elsewhere rays take long steps without asking the network, and what is recognised as noise
of the field is no surface at all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label
from scipy.spatial import KDTree

from nispcodec.decode.components import OUTSIDE, spurious
from nispcodec.decode.evaluate import evaluate, gradient
from nispcodec.decode.extract import LIMIT, extract
from nispcodec.network import Network

Floats = NDArray[np.float32]
Cells = NDArray[np.int64]

COARSE, HALVINGS = 32, 2
# Noise is looked for on a surface of this resolution.
NOISE_RESOLUTION = 96
SOME = 4096
HALVES = np.indices((2, 2, 2)).reshape(3, -1).T


@dataclass(frozen=True)
class Space:
    """The cube [-1.02, 1.02]^3 in cells.

    clear  (r, r, r) float32: the surface is no nearer than this to any point of the cell; 0 where
           it may pass through the cell, more than 0 elsewhere
    slope  how fast the field may change near the surface
    """

    clear: Floats
    slope: float

    @property
    def cell(self) -> np.float32:
        """Edge of a cell."""
        return np.float32(2 * LIMIT / len(self.clear))


def bounding_space(network: Network) -> Space:
    """The cells that may hold the surface of an SDF network, without those that hold noise."""
    cells, count = np.indices((COARSE,) * 3).reshape(3, -1).T, COARSE
    cells = _crossed(network, cells, count)
    for _ in range(HALVINGS):
        count *= 2
        cells = _crossed(network, (2 * cells[:, None] + HALVES).reshape(-1, 3), count)
    cells = _without_noise(network, cells, count)
    gap = distance_transform_edt(~_marked(cells, count))
    clear = np.where(gap > 0, np.maximum(gap - np.sqrt(3), 1e-3), 0) * (2 * LIMIT / count)
    return Space(clear.astype(np.float32), _slope(network, _centres(cells, count)))


def _crossed(network: Network, cells: Cells, count: int) -> Cells:
    """Those cells, of `count` along an edge, that the surface may cross."""
    centres = _centres(cells, count)
    radius = np.sqrt(3) * LIMIT / count
    return cells[np.abs(evaluate(network, centres)[:, 0]) <= _slope(network, centres) * radius]


def _slope(network: Network, points: Floats) -> float:
    """A bound on the field's slope around the points: 1 for an SDF, for a fitted one nearly."""
    some = points[:: 1 + len(points) // SOME]
    slopes = np.linalg.norm(gradient(network, some)[1], axis=1)
    return float(1.1 * np.percentile(slopes, 99)) if len(slopes) else 1.0


def _without_noise(network: Network, cells: Cells, count: int) -> Cells:
    """The cells inside the unit ball, without those whose surface is recognised as noise."""
    centres = _centres(cells, count)
    reach = 2 * LIMIT / count
    inside = np.linalg.norm(centres, axis=1) < OUTSIDE + reach
    cells, centres = cells[inside], centres[inside]
    if label(_marked(cells, count), np.ones((3, 3, 3)))[1] < 2:
        return cells
    surface = extract(network, NOISE_RESOLUTION)
    unwanted, labels = spurious(network, surface)
    if not unwanted.any():
        return cells
    distances, nearest = KDTree(surface.positions).query(centres)
    return cells[~unwanted[labels[nearest]] | (distances > 2 * reach)]


def _marked(cells: Cells, count: int) -> NDArray[np.bool_]:
    marked = np.zeros((count,) * 3, np.bool_)
    marked[tuple(cells.T)] = True
    return marked


def _centres(cells: Cells, count: int) -> Floats:
    return ((cells + 0.5) * (2 * LIMIT / count) - LIMIT).astype(np.float32)
