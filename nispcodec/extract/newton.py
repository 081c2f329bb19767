"""Moving points onto the zero set of the SDF."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array
from nispcodec.core.network import Network
from nispcodec.extract.grid import chunks
from nispcodec.infer.evaluate import evaluate, gradient
from nispcodec.infer.parallel import parallel_for


def onto_surface(
    network: Network, points: Float32Array, max_move: float, steps: int
) -> Float32Array:
    """Points (n, 3) float32, normalized frame, after Newton steps along the field's gradient.

    The gradient is taken once, at the start: the points are near the surface already. A step is
    taken only where it brings the field nearer to 0, and no point moves farther than `max_move`
    along an axis: where the field is no distance field, points stay where they are.
    """
    result = np.empty_like(points)

    def move(part: slice) -> None:
        result[part] = _moved(network, points[part], max_move, steps)

    parallel_for(move, chunks(len(points)))
    return result


def _moved(network: Network, points: Float32Array, max_move: float, steps: int) -> Float32Array:
    values, slopes = gradient(network, points)
    steepness = (slopes * slopes).sum(axis=1, keepdims=True)
    direction = slopes / np.maximum(steepness, np.float32(1e-6))
    moved = points
    for _ in range(steps):
        trial = points + np.clip(moved - values[:, None] * direction - points, -max_move, max_move)
        trial_values = evaluate(network, trial)[:, 0]
        better = np.abs(trial_values) < np.abs(values)
        moved = np.where(better[:, None], trial, moved)
        values = np.where(better, trial_values, values)
    return moved
