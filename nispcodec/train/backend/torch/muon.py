"""Muon: momentum, of which every matrix is made orthogonal.

Jordan et al., "Muon: An optimizer for hidden layers in neural networks", 2024.
"""

from __future__ import annotations

import torch
from torch import Tensor

from nispcodec.train.backend.torch.stack import Matrices, Stack
from nispcodec.train.config import MuonConfig

TINY = 1e-12


class Muon:
    """Minimizes over `matrices` of a vector of weights. Call `step` after `backward`.

    The momentum holds about this `share` of all gradients so far.
    """

    momentum: Tensor | None = None
    steps = 0

    def __init__(
        self, weights: Tensor, matrices: Matrices, share: float, config: MuonConfig = MuonConfig()
    ) -> None:
        self.stack = Stack(weights, matrices)
        self.share, self.config = share, config

    @torch.no_grad()
    def step(self, scale: float) -> None:
        """One step of every matrix, by its rate times `scale`."""
        gradient = self.stack.gradient()
        if self.momentum is None:
            self.momentum = torch.zeros_like(gradient)
        self.steps += 1
        held = min(max(self.share * self.steps, self.config.least), self.config.most)
        memory = 1 - 1 / held
        self.momentum.mul_(memory).add_(gradient)
        # Nesterov's: as the momentum will be.
        ahead = gradient + memory * self.momentum
        size = self.config.size * (max(gradient.shape[1:]) / held) ** 0.5
        self.stack.subtract(orthogonal(ahead, self.config), size * scale)


def orthogonal(matrices: Tensor, config: MuonConfig = MuonConfig()) -> Tensor:
    """About the nearest orthogonal matrices: singular values (n, r, c) become 0.7 to 1.2."""
    wide = matrices.shape[1] <= matrices.shape[2]
    found = matrices if wide else matrices.mT
    found = found / (found.norm(dim=(1, 2), keepdim=True) + TINY)
    first, third, fifth = config.quintic
    for _ in range(config.rounds):
        square = found @ found.mT
        factor = torch.baddbmm(square, square, square, beta=third, alpha=fifth)
        found = torch.baddbmm(found, factor, found, beta=first)
    return found if wide else found.mT
