"""Fit a system that draws rays to the pictures of a scene, and draw what it has learned."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from benchmarks.paper.rays import Rays

# Rays at a time where a whole picture is drawn: bounds the memory.
AT_ONCE = 1 << 13


class Drawer(nn.Module):
    """What learns from pictures: called with rays, it gives colors (n, 3).

    With a generator it may take samples at random, without it draws the same each time.
    """

    def penalty(self) -> Tensor | float:
        """What is added to the loss of the latest rays."""
        return 0.0


@dataclass(frozen=True)
class ViewSchedule:
    """How long and how to learn.

    steps   of the optimizer (Adam)
    rays    a step
    rate    the first learning rate; it falls to `last` of that along half a cosine
    warmup  steps in which the rate rises from 0
    clip    the norm that a gradient may have
    """

    steps: int
    rays: int
    rate: float
    last: float = 0.02
    warmup: int = 50
    clip: float = 1.0

    def share(self, step: int) -> float:
        """Of the rate, at a step."""
        falling = (1 + math.cos(math.pi * step / self.steps)) / 2
        return min(1.0, (step + 1) / self.warmup) * (self.last + (1 - self.last) * falling)


def fit_views(
    drawer: Drawer,
    rays: Rays,
    colors: Tensor,
    schedule: ViewSchedule,
    seed: int,
    listen: Callable[[int, float], None] = lambda step, loss: None,
) -> None:
    """Fit to the colors (n, 3) of n rays by mean squared error; `listen` hears (step, loss)."""
    random = torch.Generator().manual_seed(seed)
    optimizer = torch.optim.Adam(drawer.parameters(), lr=schedule.rate)
    for step in range(schedule.steps):
        chosen = torch.randint(len(rays), (schedule.rays,), generator=random).to(colors.device)
        error = (drawer(rays[chosen], random) - colors[chosen]).square().mean()
        optimizer.zero_grad()
        (error + drawer.penalty()).backward()
        nn.utils.clip_grad_norm_(drawer.parameters(), schedule.clip)
        for group in optimizer.param_groups:
            group["lr"] = schedule.rate * schedule.share(step)
        optimizer.step()
        listen(step, error.item())


@torch.no_grad()
def drawn(drawer: Drawer, rays: Rays) -> Tensor:
    """Colors (n, 3) in [0, 1] of n rays."""
    starts = range(0, len(rays), AT_ONCE)
    parts = [drawer(rays[slice(start, start + AT_ONCE)]) for start in starts]
    return torch.cat(parts).clamp(0, 1)
