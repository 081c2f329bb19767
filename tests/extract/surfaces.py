"""What is asked of every surface that the decoder makes."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array, FloatArray, IntArray


def assert_closed(faces: IntArray) -> None:
    """Every directed edge occurs once, and once the other way round: closed, oriented, manifold."""
    starts = faces.astype(np.int64)
    edges = np.stack([starts, np.roll(starts, -1, axis=1)], axis=2).reshape(-1, 2)
    assert (edges[:, 0] != edges[:, 1]).all()
    forth = edges[:, 0] << 32 | edges[:, 1]
    back = edges[:, 1] << 32 | edges[:, 0]
    assert len(np.unique(forth)) == len(forth)
    assert np.array_equal(np.sort(forth), np.sort(back))


def assert_sound(positions: FloatArray, faces: IntArray) -> None:
    """Closed, no vertex twice, none unused, no empty triangle."""
    assert_closed(faces)
    assert len(np.unique(positions, axis=0)) == len(positions)
    assert len(np.unique(faces)) == len(positions)
    assert areas(positions, faces).min() > 0


def areas(positions: FloatArray, faces: IntArray) -> Float64Array:
    """Area of each triangle."""
    a, b, c = positions.astype(np.float64)[faces].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
