"""Where a placement has the points of a part."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.mesh_part import Placement, Quaternion


def placed_points(placement: Placement, points: Float64Array) -> Float64Array:
    """Points (n, 3) of a part where a copy of it has them, both in the normalized frame."""
    turned = rotation_matrix(placement.rotation)
    if placement.mirrored:
        turned = turned * np.array([-1.0, 1.0, 1.0])
    return placement.scale * (points @ turned.T) + np.asarray(placement.offset)


def rotation_matrix(quaternion: Quaternion) -> Float64Array:
    """(3, 3): the rotation by a quaternion, w first, which is divided by its length."""
    w, x, y, z = np.asarray(quaternion) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
