"""Muon: momentum, of which every matrix is made orthogonal.

Jordan et al., "Muon: An optimizer for hidden layers in neural networks", 2024.
"""

from __future__ import annotations

import torch
from torch import Tensor

from nispcodec.train.backend.torch.stack import Matrices, Stack

SIZE = 0.7
"""Root mean square of a move at a rate of 1, without memory. The longer moves are alike, the
farther they lead: as many add up as are remembered, and the square root of that is made up for."""

LEAST, MOST = 20.0, 400.0
"""How many gradients the momentum holds. The more, the nearer the fit ends; but with many from the
start it ends in bad places."""

QUINTIC = 3.4445, -4.7750, 2.0315
ROUNDS = 5
TINY = 1e-12


class Muon:
    """Minimizes over `matrices` of a vector of weights. Call `step` after `backward`.

    The momentum holds about this `share` of all gradients so far.
    """

    momentum: Tensor | None = None
    steps = 0

    def __init__(self, weights: Tensor, matrices: Matrices, share: float) -> None:
        self.stack = Stack(weights, matrices)
        self.share = share

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """Move every matrix by its rate times `scale`."""
        gradient = self.stack.gradient()
        if self.momentum is None:
            self.momentum = torch.zeros_like(gradient)
        self.steps += 1
        held = min(max(self.share * self.steps, LEAST), MOST)
        memory = 1 - 1 / held
        self.momentum.mul_(memory).add_(gradient)
        # Nesterov's: as the momentum will be.
        ahead = gradient + memory * self.momentum
        size = SIZE * (max(gradient.shape[1:]) / held) ** 0.5
        self.stack.move(orthogonal(ahead), size * scale)


def orthogonal(matrices: Tensor) -> Tensor:
    """About the nearest orthogonal matrices: singular values (n, r, c) become 0.7 to 1.2."""
    wide = matrices.shape[1] <= matrices.shape[2]
    found = matrices if wide else matrices.mT
    found = found / (found.norm(dim=(1, 2), keepdim=True) + TINY)
    first, third, fifth = QUINTIC
    for _ in range(ROUNDS):
        square = found @ found.mT
        factor = torch.baddbmm(square, square, square, beta=third, alpha=fifth)
        found = torch.baddbmm(found, factor, found, beta=first)
    return found if wide else found.mT
