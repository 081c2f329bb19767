"""Sparse weighted least squares of points that are means of vertices, by conjugate gradients."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nispcodec.core.arrays import Float64Array, Int64Array
from nispcodec.simplify.config import SolverConfig


@dataclass(frozen=True)
class Pull:
    """s points, each a mean of vertices, and where each should be.

    vertices    (s, k) int64, and means (s, k): a point is the sum of means * vertices
    targets     (s, d)
    weights     (s,)
    directions  (s, d) unit vectors across which a miss counts less; None: all ways alike
    sliding     by how much less: the weight across, of that along a direction
    """

    vertices: Int64Array
    means: Float64Array
    targets: Float64Array
    weights: Float64Array
    directions: Float64Array | None = None
    sliding: float = 1.0

    def matrix(self, count: int) -> Any:
        """(s, count) sparse: vertices to points."""
        from scipy.sparse import csr_matrix

        s, k = self.vertices.shape
        ends = np.arange(0, s * k + 1, k)
        return csr_matrix((self.means.ravel(), self.vertices.ravel(), ends), shape=(s, count))


def pulled(
    start: Float64Array, pulls: Sequence[Pull], damping: float, config: SolverConfig
) -> Float64Array:
    """Vertices (n, d), near `start` (n, d), that best follow all pulls.

    damping: weight of the start, as a part of the mean weight of a vertex.
    """
    from scipy.sparse.linalg import LinearOperator, cg

    system = _System.of(start, pulls, damping)
    size = start.size
    shape = start.shape
    operator = LinearOperator((size, size), matvec=lambda x: system(x.reshape(shape)).ravel())
    inverse = np.linalg.inv(system.blocks)
    preconditioner = LinearOperator(
        (size, size), matvec=lambda x: np.einsum("nij,nj->ni", inverse, x.reshape(shape)).ravel()
    )
    # The way from the start: a tolerance for places would be one of their distance from 0.
    left = (system.right - system(start)).ravel()
    way, _ = cg(operator, left, rtol=config.tolerance, maxiter=config.steps, M=preconditioner)
    return start + np.asarray(way, np.float64).reshape(shape)


@dataclass(frozen=True)
class _System:
    """The normal equations: what is alike for all d axes as a matrix, the rest by directions.

    isotropic (n, n) sparse; directed: matrix, its transpose, weights, directions; blocks (n, d, d)
    the diagonal; right (n, d)
    """

    isotropic: Any
    directed: list[tuple[Any, Any, Float64Array, Float64Array]]
    blocks: Float64Array
    right: Float64Array

    @staticmethod
    def of(start: Float64Array, pulls: Sequence[Pull], damping: float) -> _System:
        from scipy.sparse import csr_matrix, diags

        count, axes = start.shape
        isotropic, right = csr_matrix((count, count)), np.zeros((count, axes))
        blocks, directed = np.zeros((count, axes, axes)), []
        for pull in pulls:
            matrix = pull.matrix(count)
            across = pull.weights * (1.0 if pull.directions is None else pull.sliding)
            isotropic = isotropic + matrix.T @ diags(across) @ matrix
            right += matrix.T @ (across[:, None] * pull.targets)
            if pull.directions is not None:
                along, ways = pull.weights * (1 - pull.sliding), pull.directions
                aims = along * (ways * pull.targets).sum(axis=1)
                right += matrix.T @ (aims[:, None] * ways)
                directed.append((matrix, matrix.T.tocsr(), along, ways))
                outer = along[:, None, None] * ways[:, :, None] * ways[:, None, :]
                squares = matrix.power(2).T @ outer.reshape(len(along), -1)
                blocks += squares.reshape(blocks.shape)
        every = np.arange(axes)
        blocks[:, every, every] += isotropic.diagonal()[:, None]
        held = damping * float(np.einsum("nii->n", blocks).mean()) / axes + np.finfo(float).tiny
        blocks[:, every, every] += held
        isotropic = isotropic + diags(np.full(count, held))
        return _System(isotropic.tocsr(), directed, blocks, right + held * start)

    def __call__(self, vertices: Float64Array) -> Float64Array:
        result: Float64Array = self.isotropic @ vertices
        for matrix, transposed, weights, ways in self.directed:
            sizes = weights * ((matrix @ vertices) * ways).sum(axis=1)
            result = result + transposed @ (sizes[:, None] * ways)
        return result
