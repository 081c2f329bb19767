"""SOAP: Adam run in the eigenbasis of Shampoo's preconditioner.

Vyas et al., "SOAP: Improving and Stabilizing Shampoo using Adam", 2024. Every parameter here is a
small matrix, so both sides are always preconditioned.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from nispcodec.train.backend.torch.stack import Matrices
from nispcodec.train.config import SoapConfig
from nispcodec.train.soap_bases import bases


class Soap:
    """Minimizes over `matrices` of a vector of weights. Call `step` after `backward`."""

    def __init__(
        self, weights: Tensor, matrices: Matrices, config: SoapConfig = SoapConfig()
    ) -> None:
        self._weights, self._config = weights, config
        self._matrices = [(places.to(weights.device), rate) for places, rate in matrices]
        self._states: list[_State] = []
        self._steps = 0

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """One step of every matrix, by its rate times `scale`; the first call only measures."""
        assert self._weights.grad is not None
        gradients = [self._weights.grad[places] for places, _ in self._matrices]
        if not self._states:
            self._states = [_State.first(gradient, self._config) for gradient in gradients]
            return
        self._steps += 1
        refreshed = self._steps % self._config.refresh_every == 0
        every = zip(self._matrices, gradients, self._states, strict=True)
        for (places, rate), gradient, state in every:
            self._weights[places] -= rate * scale * state.direction(gradient, self._steps)
            if refreshed:
                state.refresh()


@dataclass
class _State:
    """Of one matrix: moments, and the two sides' covariances and eigenbases."""

    mean: Tensor
    square: Tensor
    left: Tensor
    right: Tensor
    left_basis: Tensor
    right_basis: Tensor
    config: SoapConfig

    @staticmethod
    def first(gradient: Tensor, config: SoapConfig) -> _State:
        left, right = (torch.from_numpy(side) for side in bases(gradient.cpu().numpy()))
        return _State(
            mean=torch.zeros_like(gradient),
            square=torch.zeros_like(gradient),
            left=gradient @ gradient.mT,
            right=gradient.mT @ gradient,
            left_basis=left.to(gradient.device),
            right_basis=right.to(gradient.device),
            config=config,
        )

    def direction(self, gradient: Tensor, steps: int) -> Tensor:
        """Adam's step in the rotated basis, rotated back; updates moments and covariances."""
        beta, epsilon = self.config.beta, self.config.epsilon
        rotated = self.left_basis.mT @ gradient @ self.right_basis
        self.mean.lerp_(gradient, 1 - beta)
        self.square.lerp_(rotated.square_(), 1 - beta)
        self.left.lerp_(gradient @ gradient.mT, 1 - beta)
        self.right.lerp_(gradient.mT @ gradient, 1 - beta)
        correction = 1 - beta**steps
        mean = self.left_basis.mT @ self.mean @ self.right_basis
        scaled = (mean / correction) / ((self.square / correction).sqrt_().add_(epsilon))
        return self.left_basis @ scaled @ self.right_basis.mT

    def refresh(self) -> None:
        """One power iteration towards the eigenbasis; the second moments follow its order."""
        self.left_basis, rows = _iterate(self.left, self.left_basis)
        self.right_basis, columns = _iterate(self.right, self.right_basis)
        self.square = self.square[rows][:, columns]


def _iterate(covariance: Tensor, basis: Tensor) -> tuple[Tensor, Tensor]:
    eigenvalues = (basis * (covariance @ basis)).sum(dim=0)
    order = torch.argsort(eigenvalues, descending=True, stable=True)
    return torch.linalg.qr(covariance @ basis[:, order])[0], order
