"""A scene representation network of one asset (Sitzmann et al. 2019), for a processor.

As published: features of points, an LSTM that marches along each ray by the features it meets, and
a network from the features where it stops to a color. There is one asset, so its weights are
trained themselves, where the published method has a network that makes them for each of many.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn

from benchmarks.paper.rays import Rays
from benchmarks.paper.view_training import Drawer


@dataclass(frozen=True)
class SrnConfig:
    """The size of the networks and the march.

    features  width and number of the layers from a point to its features (published: four of 256)
    painter   width and number of the layers from features to a color (published: five of 256)
    state     of the LSTM (as published)
    marches   steps of the LSTM (as published)
    start     how far within the box the march begins (normalized frame)
    behind    weight of the squared distance by which a ray ends before the box
    """

    features: tuple[int, ...] = (128,) * 3
    painter: tuple[int, ...] = (128,) * 3
    state: int = 16
    marches: int = 10
    start: float = 0.05
    behind: float = 1.0


class SceneRepresentation(Drawer):
    """Rays to colors, by features where each ray is thought to end."""

    def __init__(self, config: SrnConfig = SrnConfig()) -> None:
        super().__init__()
        self.config = config
        width = config.features[-1]
        self.features = nn.Sequential(*_layers((3, *config.features)))
        self.marcher = nn.LSTMCell(width, config.state)
        self.step = nn.Linear(config.state, 1)
        painter = _layers((width, *config.painter))
        self.painter = nn.Sequential(*painter, nn.Linear(config.painter[-1], 3))
        self._before: Tensor | float = 0.0

    def forward(self, rays: Rays, random: torch.Generator | None = None) -> Tensor:
        """Colors (n, 3); nothing is random."""
        distances = self.march(rays)
        self._before = (rays.near - distances).clamp(min=0).square().mean()
        colors: Tensor = self.painter(self.features(rays.at(distances)[:, 0]))
        return colors

    def march(self, rays: Rays) -> Tensor:
        """Distances (n, 1) at which the rays end."""
        distances = rays.near + self.config.start
        state = None
        for _ in range(self.config.marches):
            state = self.marcher(self.features(rays.at(distances)[:, 0]), state)
            distances = distances + self.step(state[0])
        return distances

    def penalty(self) -> Tensor | float:
        """Of the latest rays: a march must not end before the box."""
        return self.config.behind * self._before


def _layers(widths: tuple[int, ...]) -> list[nn.Module]:
    """Dense layers, each normalized (Ba et al. 2016) and rectified."""
    layers: list[nn.Module] = []
    for inputs, outputs in pairwise(widths):
        norm = nn.LayerNorm(outputs, elementwise_affine=False)
        layers += [nn.Linear(inputs, outputs), norm, nn.ReLU()]
    return layers
