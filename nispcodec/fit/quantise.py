"""Quantisation-aware training: the network computes with rounded weights and learns its steps.

Weights take straight-through gradients (Bengio et al. 2013), steps those of Esser et al., "Learned
Step Size Quantization", 2020. The rate is the entropy of a Gaussian of the weights' variance on the
step's grid; its gradient makes steps coarser and weights smaller, as far as the distortion allows.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import torch
from torch import Tensor
from torch.nn import functional

STEP_RATE = 0.01
"""Learning rate of the steps, in octaves."""

STEP_BETAS = 0.95, 0.99
"""Adam's, for the steps."""

FIRST_BITS = 8.0
GAUSSIAN_BITS = 0.5 * math.log2(2 * math.pi * math.e)
FLOOR = 1e-6
TINY = 1e-8


class Quantiser:
    """One step for each group of weights: `groups` (n,) numbers the group of each of n weights.

    Weights that are pruned, with 0 in `kept` (n,), cost no bits; the others start with `bits` each.
    """

    def __init__(
        self,
        weights: Tensor,
        groups: Tensor,
        kept: Tensor | None = None,
        bits: float = FIRST_BITS,
    ) -> None:
        self.members = functional.one_hot(groups).T.to(weights.dtype)
        kept = torch.ones_like(weights, requires_grad=False) if kept is None else kept
        self.counts = self._sums(kept).clamp(min=1.0)
        self._number = float(self.counts.sum())
        spread = 0.5 * torch.log2(self._sums(weights.detach().square()))
        first = spread - 0.5 * torch.log2(self.counts) + GAUSSIAN_BITS - bits
        self.log_steps = first.clamp(min=math.log2(FLOOR)).requires_grad_()
        self._mean, self._square = torch.zeros_like(first), torch.zeros_like(first)
        self._learned = 0

    @property
    def steps(self) -> Tensor:
        """The step of each group."""
        return torch.exp2(self.log_steps.detach())

    def rounded(self, weights: Tensor) -> Tensor:
        """The weights as the file will hold them."""
        apply: Callable[..., Tensor] = _Rounded.apply
        return apply(weights, self.log_steps, self.members)

    @torch.no_grad()
    def settle(self, scales: list[float]) -> None:
        """Take the nearest steps that the file holds in one byte, after division by `scales`."""
        for group, scale in enumerate(scales):
            step = float(torch.exp2(self.log_steps[group]))
            self.log_steps[group] = math.log2(snapped(step / scale) * scale)

    @torch.no_grad()
    def charge(self, weights: Tensor, price: float) -> float:
        """Add the gradient of `price` times the rate; return the rate, in bits.

        A group of n weights with power p on a grid of step s costs n softplus(2 x) / 2 bits,
        x = log2(sqrt(p) / s) + `GAUSSIAN_BITS`: a Gaussian's entropy, kept above 0.
        """
        power = self._sums(weights.square()).div_(self.counts).add_(FLOOR**2)
        excess = torch.log2(power).sub_(self.log_steps, alpha=2).add_(2 * GAUSSIAN_BITS)
        slope = torch.sigmoid(excess).mul_(price)
        _add(self.log_steps, -self.counts * slope)
        pull = slope.div_(power).div_(math.log(2))
        _add(weights, weights * (pull @ self.members))
        return float(self.counts @ functional.softplus(excess)) / 2

    @torch.no_grad()
    def learn(self, excess: float) -> None:
        """Move the steps along their gradient by Adam, and all of them for `excess` bits less."""
        assert self.log_steps.grad is not None
        self._learned += 1
        for moment, seen, beta in zip(
            (self._mean, self._square),
            (self.log_steps.grad, self.log_steps.grad.square()),
            STEP_BETAS,
            strict=True,
        ):
            moment.lerp_(seen, 1 - beta)
        mean, square = (1 - beta**self._learned for beta in STEP_BETAS)
        scale = (self._square / square).sqrt_().add_(TINY)
        self.log_steps.addcdiv_(self._mean, scale, value=-STEP_RATE / mean)
        self.log_steps += excess / self._number

    def _sums(self, values: Tensor) -> Tensor:
        """The sum of every group's values."""
        return self.members @ values


def snapped(step: float) -> float:
    """The nearest number of four significant bits."""
    mantissa, exponent = math.frexp(step)
    return round(mantissa * 16) / 16 * 2.0**exponent


class _Rounded(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, weights: Tensor, log_steps: Tensor, members: Tensor) -> Tensor:
        steps = torch.exp2(log_steps) @ members
        rounded = (weights / steps).round_().mul_(steps)
        ctx.kept = rounded - weights, members
        return rounded

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor, Tensor, None]:
        error, members = ctx.kept
        return gradients[0], (members @ (gradients[0] * error)).mul_(math.log(2)), None


def _add(tensor: Tensor, gradient: Tensor) -> None:
    tensor.grad = gradient if tensor.grad is None else tensor.grad.add_(gradient)
