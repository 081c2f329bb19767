"""Matrices that are parts of one vector, as one stack: all of them take a step in one operation.

They are so small that the number of operations is what takes the time.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

Matrices = Sequence[tuple[Tensor, float]]
"""Where in a vector of weights each matrix is (r, c), and its rate."""


class Stack:
    """`matrices` of the vector `weights`, padded with zeros to one size: (count, rows, columns)."""

    def __init__(self, weights: Tensor, matrices: Matrices) -> None:
        rows, columns = (max(matrix.shape[side] for matrix, _ in matrices) for side in (0, 1))
        spots = torch.arange(len(matrices) * rows * columns).view(-1, rows, columns)
        pairs = zip(spots, matrices, strict=True)
        held = [spot[: matrix.shape[0], : matrix.shape[1]] for spot, (matrix, _) in pairs]
        device = weights.device
        self._weights = weights
        self._places = torch.cat([matrix.flatten() for matrix, _ in matrices]).to(device)
        self._spots = torch.cat([spot.flatten() for spot in held]).to(device)
        self._gradient = torch.zeros(spots.shape, device=device)
        self._rates = torch.tensor([rate for _, rate in matrices], device=device)[:, None, None]

    def gradient(self) -> Tensor:
        """That of the vector, as a stack; the next call writes it anew."""
        assert self._weights.grad is not None
        found = self._weights.grad.index_select(0, self._places)
        self._gradient.view(-1).index_copy_(0, self._spots, found)
        return self._gradient

    def subtract(self, directions: Tensor, scale: float) -> None:
        """Subtract from every matrix its direction, times its rate and `scale`."""
        steps = (directions * self._rates).view(-1).index_select(0, self._spots)
        self._weights.index_add_(0, self._places, steps, alpha=-scale)
