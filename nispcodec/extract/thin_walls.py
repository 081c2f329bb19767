"""How much of a surface has walls too thin for the cells of an extraction."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import Network
from nispcodec.extract.config import ResolutionConfig
from nispcodec.extract.newton import onto_surface
from nispcodec.infer.evaluate import evaluate, gradient


def thin_share(
    network: Network,
    points: Float32Array,
    max_move: float,
    depth: float,
    config: ResolutionConfig = ResolutionConfig(),
) -> float:
    """The share of the surface near `points` (n, 3) behind which there is no `depth` of solid.

    The points are moved onto the surface, by at most `max_move` along an axis, and from there on by
    `depth` inwards: where that leads out again, the wall is thinner. All in the normalized frame.
    The points come from the field's values, so walls that a grid's corners miss count as well.
    """
    moved = onto_surface(network, points, max_move, config.newton_steps)
    values, slopes = gradient(network, moved)
    found = np.abs(values) < config.on_surface
    if not found.any():
        return 0.0
    steepness = np.linalg.norm(slopes[found], axis=1, keepdims=True)
    inwards = -slopes[found] / np.maximum(steepness, np.float32(1e-6))
    behind = evaluate(network, moved[found] + np.float32(depth) * inwards)
    return float((behind > 0).mean())
