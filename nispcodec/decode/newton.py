"""Moving points onto the zero set of the SDF."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nispcodec.decode.evaluate import gradient
from nispcodec.network import Network

Floats = NDArray[np.float32]


def onto_surface(network: Network, points: Floats, reach: float, steps: int) -> Floats:
    """Points (n, 3) float32, normalised frame, after Newton steps along the field's gradient.

    A step is taken only where it brings the field nearer to 0, and no point moves farther than
    `reach` along an axis: where the field is no distance field, points stay where they are.
    """
    values, slopes = gradient(network, points)
    moved = points
    for _ in range(steps):
        steepness = np.maximum((slopes * slopes).sum(axis=1, keepdims=True), np.float32(1e-6))
        trial = moved - values[:, None] * slopes / steepness
        trial = points + np.clip(trial - points, -reach, reach)
        trial_values, trial_slopes = gradient(network, trial)
        better = np.abs(trial_values) < np.abs(values)
        moved = np.where(better[:, None], trial, moved)
        values = np.where(better, trial_values, values)
        slopes = np.where(better[:, None], trial_slopes, slopes)
    return moved
