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

STEP_RATE = 0.01
"""Learning rate of the steps, in octaves."""

FIRST_BITS = 8.0
GAUSSIAN_BITS = 0.5 * math.log2(2 * math.pi * math.e)
FLOOR = 1e-6


class Quantiser:
    """One step for the weights and one for the biases of each matrix, one for an embedding."""

    def __init__(self, matrices: list[Tensor], table: Tensor | None) -> None:
        self.groups = [_columns(matrix, 2 * layer) for layer, matrix in enumerate(matrices)]
        if table is not None:
            self.groups.append(torch.full((table.shape[1],), 2 * len(matrices)).to(table.device))
        self._index = torch.cat(self.groups)
        self._number = int(self._index.max()) + 1
        parameters = matrices if table is None else [*matrices, table]
        self.counts = self._sums([torch.ones_like(parameter) for parameter in parameters])
        spread = 0.5 * torch.log2(self._sums([p.detach().square() for p in parameters]))
        first = spread - 0.5 * torch.log2(self.counts) + GAUSSIAN_BITS - FIRST_BITS
        self.log_steps = first.clamp(min=math.log2(FLOOR)).requires_grad_()
        self._adam = torch.optim.Adam([self.log_steps], lr=STEP_RATE, betas=(0.95, 0.99))

    def rounded(self, parameters: list[Tensor]) -> list[Tensor]:
        """The parameters as the file will hold them."""
        pairs = zip(parameters, self.groups, strict=True)
        apply: Callable[..., Tensor] = _Rounded.apply
        return [apply(parameter, self.log_steps, group) for parameter, group in pairs]

    def steps(self, parameter: int) -> Tensor:
        """The step of each column of one parameter."""
        return torch.exp2(self.log_steps.detach())[self.groups[parameter]]

    @torch.no_grad()
    def settle(self, rates: list[float]) -> None:
        """Take the nearest steps that the file holds in one byte; `rates` as `Module.rates`."""
        for group, rate in zip(self.groups, rates, strict=True):
            for index in sorted(set(group.tolist())):
                step = float(torch.exp2(self.log_steps[index]))
                self.log_steps[index] = math.log2(snapped(step / rate) * rate)

    @torch.no_grad()
    def charge(self, parameters: list[Tensor], price: float) -> None:
        """Add the gradient of `price` times the rate in bits.

        A group of n weights with power p on a grid of step s costs n softplus(2 x) / 2 bits,
        x = log2(sqrt(p) / s) + `GAUSSIAN_BITS`: a Gaussian's entropy, kept above 0.
        """
        power = self._sums([parameter.square() for parameter in parameters]) / self.counts
        power += FLOOR**2
        excess = 2 * (0.5 * torch.log2(power) - self.log_steps + GAUSSIAN_BITS)
        slope = torch.sigmoid(excess)
        _add(self.log_steps, -price * self.counts * slope)
        pull = price * slope / (power * math.log(2))
        for parameter, group in zip(parameters, self.groups, strict=True):
            _add(parameter, parameter * pull[group])

    def learn(self, moving: bool) -> None:
        """Move the steps along their gradient, unless they are settled; forget the gradient."""
        if moving:
            self._adam.step()
        self.log_steps.grad = None

    def _sums(self, values: list[Tensor]) -> Tensor:
        """The sum of every group's values."""
        joined = torch.cat([value.sum(0) for value in values])
        return joined.new_zeros(self._number).index_add_(0, self._index, joined)


def snapped(step: float) -> float:
    """The nearest number of four significant bits."""
    mantissa, exponent = math.frexp(step)
    return round(mantissa * 16) / 16 * 2.0**exponent


class _Rounded(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, parameter: Tensor, log_steps: Tensor, group: Tensor) -> Tensor:
        steps = torch.exp2(log_steps)[group]
        rounded = (parameter / steps).round_().mul_(steps)
        ctx.kept = rounded - parameter, group, len(log_steps)
        return rounded

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor, Tensor, None]:
        error, group, count = ctx.kept
        along = (gradients[0] * error).sum(0) * math.log(2)
        return gradients[0], along.new_zeros(count).index_add_(0, group, along), None


def _columns(matrix: Tensor, first: int) -> Tensor:
    """Group of each column of [W | b]."""
    group = torch.full((matrix.shape[1],), first, device=matrix.device)
    group[-1] = first + 1
    return group


def _add(tensor: Tensor, gradient: Tensor) -> None:
    tensor.grad = gradient if tensor.grad is None else tensor.grad.add_(gradient)
