"""The turn, scale, reflection and shift that bring points onto points (Umeyama 1991)."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.mesh_part import Placement, Quaternion


def similarity(source: Float64Array, target: Float64Array, mirrored: bool) -> Placement:
    """The placement that brings points (n, 3) as near to (n, 3) as least squares have it.

    Of points in a plane either sort is as near as the other: `mirrored` says which is wanted.
    """
    given = source * [-1.0, 1.0, 1.0] if mirrored else source
    center, there = given.mean(axis=0), target.mean(axis=0)
    left, sizes, right = np.linalg.svd((given - center).T @ (target - there))
    signs = np.array([1.0, 1.0, np.sign(np.linalg.det(left @ right)) or 1.0])
    turn = ((left * signs) @ right).T
    spread = max(float(np.square(given - center).sum()), np.finfo(np.float64).tiny)
    # A single spot has no size that could change.
    scale = float((sizes * signs).sum()) / spread or 1.0
    shift = there - scale * (turn @ center)
    return Placement(_quaternion(turn), (shift[0], shift[1], shift[2]), scale, mirrored)


def _quaternion(turn: Float64Array) -> Quaternion:
    """Of a rotation matrix (3, 3), w first and not below 0 (Bar-Itzhack 2000)."""
    trace = np.trace(turn)
    form = np.zeros((4, 4))
    form[0, 0] = trace
    form[0, 1:] = form[1:, 0] = [
        turn[2, 1] - turn[1, 2],
        turn[0, 2] - turn[2, 0],
        turn[1, 0] - turn[0, 1],
    ]
    form[1:, 1:] = turn + turn.T - trace * np.eye(3)
    w, x, y, z = np.linalg.eigh(form)[1][:, -1]
    sign = -1.0 if w < 0 else 1.0
    return sign * float(w), sign * float(x), sign * float(y), sign * float(z)
