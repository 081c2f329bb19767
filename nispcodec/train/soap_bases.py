"""The bases that SOAP starts from: those of the first gradient, completed in one defined way."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array

TINY = 1e-6


def bases(gradient: Float32Array) -> tuple[Float32Array, Float32Array]:
    """Orthonormal bases (r, r), (c, c) of a gradient (r, c), its largest singular values first.

    Where the gradient has no say any basis would do. It comes from the Householder reflections that
    complete the others, so that backends whose gradients differ in the last bit still agree.
    """
    left, values, right = np.linalg.svd(gradient.astype(np.float64), full_matrices=False)
    rank = int((values > TINY * values[0]).sum()) if values.size else 0
    return _completed(left[:, :rank]), _completed(right[:rank].T)


def _completed(directions: Float64Array) -> Float32Array:
    """The orthonormal columns (n, k) and as many more as make a basis (n, n)."""
    count = directions.shape[1]
    basis = np.linalg.qr(directions, mode="complete")[0]
    basis[:, :count] = directions
    return np.ascontiguousarray(basis, dtype=np.float32)
