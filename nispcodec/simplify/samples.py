"""Points spread over a surface, each in a cell of area of its own."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.simplify.closest import Hits, Tree
from nispcodec.simplify.config import FitConfig


def spread(tree: Tree, count: int, rng: np.random.Generator) -> Hits:
    """About `count` points, evenly by area, in the order of the faces."""
    cumulative = np.cumsum(tree.areas)
    drawn = (np.arange(count) + rng.random(count)) / count * cumulative[-1]
    faces = np.minimum(np.searchsorted(cumulative, drawn), len(cumulative) - 1)
    root, second = np.sqrt(rng.random(count)), rng.random(count)
    weights = np.stack([1 - root, root * (1 - second), root * second], axis=1)
    positions: Float64Array = np.einsum("nk,nkd->nd", weights, tree.corners[faces])
    return Hits(faces, weights, positions)


def sample_count(vertices: int, config: FitConfig) -> int:
    """How many points tell so many vertices where to go."""
    return int(np.clip(config.samples * vertices, config.fewest, config.most))
