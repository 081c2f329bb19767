"""A neural radiance field of one asset (Mildenhall et al. 2020), small enough for a processor.

As published: Fourier features of points and of directions, a density and a color along each ray,
stratified samples, and others where the first found something. One network serves both, where the
published method has two, and colors are taken at the latter alone; the background is white.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import torch
from torch import Tensor, nn

from benchmarks.paper.rays import Rays
from benchmarks.paper.view_training import Drawer


@dataclass(frozen=True)
class NerfConfig:
    """The size of the network and its samples.

    hidden      width and number of the layers before the density (published: eight of 256)
    color       width of the layer that sees the direction (published: 128)
    points      Fourier levels of points: the last has a wave two pixels long (published: 10)
    directions  Fourier levels of directions (published: 4)
    coarse      stratified samples a ray (published: 64)
    fine        samples a ray where the coarse ones found something (published: 128)
    uniform     share of the fine samples' probability that is even along the ray
    """

    hidden: tuple[int, ...] = (64,) * 4
    color: int = 32
    points: int = 7
    directions: int = 2
    coarse: int = 24
    fine: int = 32
    uniform: float = 0.1


class RadianceField(Drawer):
    """Rays to colors, by a density and a color at every point."""

    def __init__(self, config: NerfConfig = NerfConfig()) -> None:
        super().__init__()
        self.config = config
        widths = (3 + 6 * config.points, *config.hidden)
        self.trunk = nn.Sequential(*(layer for pair in pairwise(widths) for layer in _dense(*pair)))
        self.density = nn.Linear(widths[-1], 1)
        seen = widths[-1] + 3 + 6 * config.directions
        self.color = nn.Sequential(*_dense(seen, config.color), nn.Linear(config.color, 3))

    def forward(self, rays: Rays, random: torch.Generator | None = None) -> Tensor:
        """Colors (n, 3) on white; without `random` samples are in the middles of their strata."""
        with torch.no_grad():
            coarse = stratified(rays, self.config.coarse, random)
            weights = opacities(self._densities(rays, coarse)[0], coarse, rays)
            distances = self._finer(rays, weights, random)
        densities, features = self._densities(rays, distances)
        weights = opacities(densities, distances, rays)
        colors = self._colors(rays, features)
        return (weights[..., None] * colors).sum(dim=1) + 1 - weights.sum(dim=1, keepdim=True)

    def _densities(self, rays: Rays, distances: Tensor) -> tuple[Tensor, Tensor]:
        """Densities (n, k) and features (n, k, width)."""
        features = self.trunk(fourier(rays.at(distances), self.config.points))
        return nn.functional.softplus(self.density(features)[..., 0] - 1), features

    def _colors(self, rays: Rays, features: Tensor) -> Tensor:
        seen = fourier(rays.directions, self.config.directions)[:, None]
        seen = seen.expand(-1, features.shape[1], -1)
        return torch.sigmoid(self.color(torch.cat([features, seen], dim=-1)))

    def _finer(self, rays: Rays, weights: Tensor, random: torch.Generator | None) -> Tensor:
        """Distances (n, fine), by the probability that the ray ends in each coarse stratum."""
        config = self.config
        shares = weights / weights.sum(dim=1, keepdim=True).clamp(min=1e-6)
        shares = (1 - config.uniform) * shares + config.uniform / config.coarse
        ends = shares.cumsum(dim=1) / shares.sum(dim=1, keepdim=True)
        wanted = strata(len(rays), config.fine, weights.device, random)
        stratum = torch.searchsorted(ends, wanted).clamp(max=config.coarse - 1)
        end, share = ends.gather(1, stratum), shares.gather(1, stratum)
        within = ((wanted - end) / share + 1).clamp(0, 1)
        return rays.near + (rays.far - rays.near) * (stratum + within) / config.coarse


def _dense(inputs: int, outputs: int) -> tuple[nn.Module, nn.Module]:
    return nn.Linear(inputs, outputs), nn.ReLU()


def fourier(values: Tensor, levels: int) -> Tensor:
    """(..., d + 2 d levels): the values, and sine and cosine of them times pi, 2 pi, 4 pi, ..."""
    scales = math.pi * 2.0 ** torch.arange(levels, device=values.device)
    angles = (values[..., None, :] * scales[:, None]).flatten(-2)
    return torch.cat([values, angles.sin(), angles.cos()], dim=-1)


def strata(rays: int, count: int, device: torch.device, random: torch.Generator | None) -> Tensor:
    """(rays, count) in [0, 1): one number in each of `count` equal parts, the middle without."""
    shape = (rays, count)
    offset = torch.full(shape, 0.5) if random is None else torch.rand(shape, generator=random)
    return ((torch.arange(count) + offset) / count).to(device)


def stratified(rays: Rays, count: int, random: torch.Generator | None) -> Tensor:
    """Distances (n, count), one in each of `count` equal parts of the ray within the box."""
    shares = strata(len(rays), count, rays.near.device, random)
    return rays.near + (rays.far - rays.near) * shares


def opacities(densities: Tensor, distances: Tensor, rays: Rays) -> Tensor:
    """(n, k): the shares of the light from rising distances (n, k) with such densities."""
    lengths = torch.diff(distances, dim=1, append=rays.far).clamp(min=0)
    depth = densities * lengths
    before = depth.cumsum(dim=1) - depth
    return torch.exp(-before) - torch.exp(-before - depth)
