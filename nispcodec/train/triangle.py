"""Upper triangles of square matrices in half the memory, as LAPACK packs them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from nispcodec.core.arrays import Float32Array


@dataclass
class Triangle:
    """The upper triangle of a matrix (size, size), float32.

    Packed in rectangular full format (Gustavson et al., ACM TOMS 37, 2010), which is as fast as a
    whole matrix where others that pack are not.
    """

    size: int
    packed: Float32Array

    @staticmethod
    def zeros(size: int) -> Triangle:
        """The triangle of a matrix of zeros (size, size)."""
        return Triangle(size, np.zeros(size * (size + 1) // 2, np.float32))

    def add(self, rows: Float32Array, weight: float) -> None:
        """Add the sum of the squares of rows (n, size), each times its transpose, times weight."""
        # Columns that are rows, as the Fortran routine wants them.
        told = (self.size, len(rows), weight, rows.T, 1.0, self.packed)
        self.packed = lapack.ssfrk(*told, uplo="U", overwrite_c=True)

    def square(self) -> Float32Array:
        """The matrix (size, size) in Fortran's order; anything may be below its diagonal."""
        found, _ = lapack.stfttr(self.size, self.packed, uplo="U")
        return found

    def set(self, square: Float32Array) -> None:
        """Take the upper triangle of a matrix (size, size)."""
        self.packed, _ = lapack.strttf(square, uplo="U")
