"""SOAP: Adam run in the eigenbasis of Shampoo's preconditioner.

Vyas et al., "SOAP: Improving and Stabilizing Shampoo using Adam", 2024. Every parameter here is a
small matrix, so both sides are always preconditioned.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

BETA = 0.95
EPSILON = 1e-8
REFRESH_EVERY = 10


@dataclass
class _State:
    """One parameter's moments and the two sides' covariance (left, right) and eigenbasis."""

    mean: Tensor
    square: Tensor
    left: Tensor
    right: Tensor
    left_basis: Tensor
    right_basis: Tensor


class Soap:
    """Minimises with one learning rate a parameter; call `step` after `backward`."""

    def __init__(self, parameters: list[Tensor], rates: list[float]) -> None:
        self.parameters = parameters
        self.rates = rates
        self.states: list[_State] = []
        self.steps = 0

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """Move every parameter by its rate times `scale`; the first call only measures."""
        gradients = [parameter.grad for parameter in self.parameters]
        present = [gradient for gradient in gradients if gradient is not None]
        if not self.states:
            self.states = [_fresh_state(gradient) for gradient in present]
            return
        self.steps += 1
        for parameter, rate, gradient, state in zip(
            self.parameters, self.rates, present, self.states, strict=True
        ):
            parameter.sub_(_direction(gradient, state, self.steps), alpha=rate * scale)
            if self.steps % REFRESH_EVERY == 0:
                _refresh(state)


def _fresh_state(gradient: Tensor) -> _State:
    left, right = gradient @ gradient.T, gradient.T @ gradient
    return _State(
        mean=torch.zeros_like(gradient),
        square=torch.zeros_like(gradient),
        left=left,
        right=right,
        left_basis=torch.linalg.eigh(left)[1].flip(1),
        right_basis=torch.linalg.eigh(right)[1].flip(1),
    )


def _direction(gradient: Tensor, state: _State, steps: int) -> Tensor:
    """Adam's step in the rotated basis, rotated back; updates moments and covariances."""
    rotated = state.left_basis.T @ gradient @ state.right_basis
    state.mean.lerp_(gradient, 1 - BETA)
    state.square.lerp_(rotated.square(), 1 - BETA)
    state.left.lerp_(gradient @ gradient.T, 1 - BETA)
    state.right.lerp_(gradient.T @ gradient, 1 - BETA)
    correction = 1 - BETA**steps
    mean = state.left_basis.T @ state.mean @ state.right_basis
    scaled = (mean / correction) / ((state.square / correction).sqrt_().add_(EPSILON))
    return state.left_basis @ scaled @ state.right_basis.T


def _refresh(state: _State) -> None:
    """One power iteration towards the eigenbasis; the second moments follow its order."""
    state.left_basis, rows = _iterate(state.left, state.left_basis)
    state.right_basis, columns = _iterate(state.right, state.right_basis)
    state.square = state.square[rows][:, columns]


def _iterate(covariance: Tensor, basis: Tensor) -> tuple[Tensor, Tensor]:
    eigenvalues = (basis * (covariance @ basis)).sum(dim=0)
    order = torch.argsort(eigenvalues, descending=True)
    return torch.linalg.qr(covariance @ basis[:, order])[0], order
