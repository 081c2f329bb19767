"""SOAP: Adam run in the eigenbasis of Shampoo's preconditioner.

Vyas et al., "SOAP: Improving and Stabilizing Shampoo using Adam", 2024. Every parameter here is a
small matrix, so both sides are always preconditioned.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

BETA = 0.95
EPSILON = 1e-8
REFRESH_EVERY = 10


@dataclass
class _State:
    """Of the padded stack: moments and the two sides' covariances and eigenbases."""

    mean: Tensor
    square: Tensor
    left: Tensor
    right: Tensor
    left_basis: Tensor
    right_basis: Tensor


class Soap:
    """Minimises over a vector of weights; `matrices` say where in it each matrix is, and its rate.

    Call `step` after `backward`. All matrices are moved in one operation, padded with zeros to the
    largest: they are so small that the number of operations is what takes the time.
    """

    state: _State | None = None

    def __init__(self, weights: Tensor, matrices: Sequence[tuple[Tensor, float]]) -> None:
        self.weights = weights
        rows, columns = (max(matrix.shape[side] for matrix, _ in matrices) for side in (0, 1))
        places = torch.arange(len(matrices) * rows * columns).view(-1, rows, columns)
        order = torch.empty(len(weights), dtype=torch.long)
        for place, (matrix, _) in zip(places, matrices, strict=True):
            order[matrix.flatten()] = place[: matrix.shape[0], : matrix.shape[1]].flatten()
        self.order = order.to(weights.device)
        self.stack = torch.zeros(len(matrices), rows, columns, device=weights.device)
        rates = torch.tensor([rate for _, rate in matrices], device=weights.device)
        self.rates = rates[:, None, None]
        self.steps = 0

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """Move every matrix by its rate times `scale`; the first call only measures."""
        assert self.weights.grad is not None
        gradient = self.stack
        gradient.view(-1).index_copy_(0, self.order, self.weights.grad)
        if self.state is None:
            self.state = _fresh_state(gradient)
            return
        self.steps += 1
        moves = (_direction(gradient, self.state, self.steps) * self.rates).view(-1)
        self.weights.sub_(moves.index_select(0, self.order), alpha=scale)
        if self.steps % REFRESH_EVERY == 0:
            _refresh(self.state)


def _fresh_state(gradient: Tensor) -> _State:
    left, right = gradient @ gradient.mT, gradient.mT @ gradient
    return _State(
        mean=torch.zeros_like(gradient),
        square=torch.zeros_like(gradient),
        left=left,
        right=right,
        left_basis=torch.linalg.eigh(left)[1].flip(2),
        right_basis=torch.linalg.eigh(right)[1].flip(2),
    )


def _direction(gradient: Tensor, state: _State, steps: int) -> Tensor:
    """Adam's step in the rotated basis, rotated back; updates moments and covariances."""
    rotated = state.left_basis.mT @ gradient @ state.right_basis
    state.mean.lerp_(gradient, 1 - BETA)
    state.square.lerp_(rotated.square_(), 1 - BETA)
    state.left.lerp_(gradient @ gradient.mT, 1 - BETA)
    state.right.lerp_(gradient.mT @ gradient, 1 - BETA)
    correction = 1 - BETA**steps
    mean = state.left_basis.mT @ state.mean @ state.right_basis
    scaled = (mean / correction) / ((state.square / correction).sqrt_().add_(EPSILON))
    return state.left_basis @ scaled @ state.right_basis.mT


def _refresh(state: _State) -> None:
    """One power iteration towards the eigenbasis; the second moments follow its order."""
    state.left_basis, rows = _iterate(state.left, state.left_basis)
    state.right_basis, columns = _iterate(state.right, state.right_basis)
    order = rows[:, :, None].expand_as(state.square)
    state.square = state.square.gather(1, order)
    state.square = state.square.gather(2, columns[:, None, :].expand_as(state.square))


def _iterate(covariance: Tensor, basis: Tensor) -> tuple[Tensor, Tensor]:
    eigenvalues = (basis * (covariance @ basis)).sum(dim=1)
    order = torch.argsort(eigenvalues, descending=True)
    sorted_basis = basis.gather(2, order[:, None, :].expand_as(basis))
    return torch.linalg.qr(covariance @ sorted_basis)[0], order
