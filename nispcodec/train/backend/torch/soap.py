"""SOAP: Adam run in the eigenbasis of Shampoo's preconditioner.

Vyas et al., "SOAP: Improving and Stabilizing Shampoo using Adam", 2024. Every parameter here is a
small matrix, so both sides are always preconditioned.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from nispcodec.train.backend.torch.stack import Matrices, Stack
from nispcodec.train.config import SoapConfig


@dataclass
class _State:
    """State of the padded stack: moments and the two sides' covariances and eigenbases."""

    mean: Tensor
    square: Tensor
    left: Tensor
    right: Tensor
    left_basis: Tensor
    right_basis: Tensor


class Soap:
    """Minimizes over `matrices` of a vector of weights. Call `step` after `backward`."""

    state: _State | None = None

    def __init__(
        self, weights: Tensor, matrices: Matrices, config: SoapConfig = SoapConfig()
    ) -> None:
        self.stack = Stack(weights, matrices)
        self.steps, self.config = 0, config

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """One step of every matrix, by its rate times `scale`; the first call only measures."""
        gradient = self.stack.gradient()
        if self.state is None:
            self.state = _fresh_state(gradient)
            return
        self.steps += 1
        direction = _direction(gradient, self.state, self.steps, self.config)
        self.stack.subtract(direction, scale)
        if self.steps % self.config.refresh_every == 0:
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


def _direction(gradient: Tensor, state: _State, steps: int, config: SoapConfig) -> Tensor:
    """Adam's step in the rotated basis, rotated back; updates moments and covariances."""
    beta, epsilon = config.beta, config.epsilon
    rotated = state.left_basis.mT @ gradient @ state.right_basis
    state.mean.lerp_(gradient, 1 - beta)
    state.square.lerp_(rotated.square_(), 1 - beta)
    state.left.lerp_(gradient @ gradient.mT, 1 - beta)
    state.right.lerp_(gradient.mT @ gradient, 1 - beta)
    correction = 1 - beta**steps
    mean = state.left_basis.mT @ state.mean @ state.right_basis
    scaled = (mean / correction) / ((state.square / correction).sqrt_().add_(epsilon))
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
