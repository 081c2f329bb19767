"""Rounding whose errors cancel: what one weight is off by, those not rounded yet make up for.

Weights on a grid are sought that raise the loss least, by its second derivatives (Gauss-Newton):
the nearest plane of Babai, "On Lovasz' lattice reduction and the nearest lattice point problem",
1986; found again as optimal brain compression and GPTQ (Frantar et al. 2022). Of a small network
the second derivatives are known whole, or in large blocks.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor
from torch.func import grad, vmap
from torch.nn import functional

from nispcodec.core.arrays import Float64Array
from nispcodec.core.errors import FitError
from nispcodec.core.network import MAX_ROW_SHIFT
from nispcodec.train.backend.torch.module import Module, snapped
from nispcodec.train.batch import Batch
from nispcodec.train.config import QuantizeConfig
from nispcodec.train.objectives import Objective
from nispcodec.train.task import Quantization

GAUSSIAN_BITS = 0.5 * math.log2(2 * math.pi * math.e)
TINY = 1e-30


def round_weights(
    module: Module,
    samples: Batch,
    quantization: Quantization,
    objective: Objective,
    generator: torch.Generator,
    config: QuantizeConfig = QuantizeConfig(),
) -> None:
    """Put the weights on a grid, with a step for each row; what is pruned costs nothing."""
    wanted = config.derivatives // len(module.places)
    count = min(max(wanted, config.least_samples), config.most_samples)
    rows = torch.randperm(len(samples), generator=generator)[:count]
    batch = samples.chosen(rows.to(samples.points.device))
    rise = _Rise(module, batch, objective, config)
    # The last of a block is rounded first: so it goes from the first layer to the last, in which
    # the outputs are linear and what went wrong before is made up for best.
    order = module.places.flip(0)
    blocks = torch.split(order, len(order) if len(order) <= config.whole else config.block)
    roots = rise.roots(blocks, generator)
    most = MAX_ROW_SHIFT if objective.own_curvature else 0
    grid = _grid(module, order, roots, quantization, most, config)
    for places, root in zip(reversed(blocks), reversed(roots), strict=True):
        values, steps = rise.least(places, root), grid[places]
        together = torch.from_numpy(nearest((values / steps).numpy(), (root * steps).numpy()))
        # Steps so coarse that the rise is no square any more: then each weight by itself.
        rise.best(places, [together * steps, (values / steps).round() * steps])


def nearest(values: Float64Array, root: Float64Array) -> Float64Array:
    """Integers x (n,) for which |root (x - values)| is small; `root` (n, n) upper triangular."""
    lines = root / np.diag(root)[:, None]
    missing, found = np.zeros_like(values), np.zeros_like(values)
    for i in reversed(range(len(values))):
        found[i] = np.round(values[i] + lines[i, i + 1 :] @ missing[i + 1 :])
        missing[i] = values[i] - found[i]
    return found


class _Rise:
    """How much the loss rises: half the square of how far the outputs are from where they were."""

    def __init__(
        self, module: Module, batch: Batch, objective: Objective, config: QuantizeConfig
    ) -> None:
        self.module, self.batch, self.damping = module, batch, objective.damping
        self.config = config
        with torch.no_grad():
            self.first = module(batch.points, batch.chart)
            self.factors = objective.factors(self.first, batch)

    def slope(self) -> Tensor:
        """Its derivatives by the weights, where they are now."""
        (slope,) = torch.autograd.grad(self(), self.module.weights)
        return slope.cpu().double()

    def least(self, places: Tensor, root: Tensor) -> Tensor:
        """Values in these places that make it least, as far as Newton's step leads there."""
        values = self.module.weights.detach().cpu().double()[places]
        slope = self.slope()[places]
        step = torch.cholesky_solve(slope[:, None], root, upper=True)[:, 0]
        return self.best(places, [values - share * step for share in self.config.newton_shares])

    @torch.no_grad()
    def best(self, places: Tensor, candidates: Sequence[Tensor]) -> Tensor:
        """The candidate for these places with the least rise, which is now there."""
        rises = []
        for values in candidates:
            self._move(places, values)
            rises.append(float(self()))
        chosen = candidates[int(np.argmin(rises))]
        self._move(places, chosen)
        return chosen

    def __call__(self) -> Tensor:
        """It, as the weights are now."""
        batch = self.batch
        off = self.module(batch.points, batch.chart) - self.first
        return (off[:, None] @ self.factors).square().sum() / (2 * len(batch))

    def _move(self, places: Tensor, values: Tensor) -> None:
        weights = self.module.weights
        weights.index_copy_(0, places.to(weights.device), values.to(weights))

    def roots(self, blocks: Sequence[Tensor], generator: torch.Generator) -> list[Tensor]:
        """Upper Cholesky factors of its second derivatives, block by block."""
        weights, batch = self.module.weights.detach(), self.batch
        sums = [torch.zeros(len(block), len(block), device=weights.device) for block in blocks]
        size = max(1, min(len(batch), self.config.entries // len(weights)))
        # One direction for each point in place of all, right in the mean.
        signs = torch.randint(2, self.factors.shape[::2], generator=generator) * 2.0 - 1
        directions = (self.factors @ signs.to(weights)[:, :, None])[:, :, 0]
        for points in torch.split(torch.arange(len(batch), device=weights.device), size):
            part, along = batch.chosen(points), directions[points]
            slopes = _slopes(self.module, weights, part, along)
            for block, total in zip(blocks, sums, strict=True):
                rows = slopes.index_select(1, block.to(slopes.device))
                total.addmm_(rows.T, rows, alpha=1 / len(batch))
        return [_root(total.cpu().double(), self.damping) for total in sums]


def _slopes(module: Module, weights: Tensor, batch: Batch, directions: Tensor) -> Tensor:
    """Derivatives (n, weights) of each point's outputs along its direction (n, outputs)."""

    def along(used: Tensor, point: Tensor, chart: Tensor, direction: Tensor) -> Tensor:
        return module.outputs(used, point[None], chart[None])[0] @ direction

    every = vmap(grad(along), in_dims=(None, 0, 0, 0))
    slopes: Tensor = every(weights, batch.points, batch.chart, directions)
    return slopes


def _root(square: Tensor, damping: float) -> Tensor:
    """Upper Cholesky factor, with ten times the damping until there is one."""
    mean = float(square.diagonal().mean()) + TINY
    if not math.isfinite(mean):
        raise FitError("weights cannot be rounded: expected finite derivatives, found NaN")
    while True:
        damped = square + damping * mean * torch.eye(len(square), dtype=square.dtype)
        root, failed = torch.linalg.cholesky_ex(damped, upper=True)
        if not failed:
            return root
        damping *= 10


def _grid(
    module: Module,
    order: Tensor,
    roots: Sequence[Tensor],
    quantization: Quantization,
    most: int,
    config: QuantizeConfig,
) -> Tensor:
    """The step of each weight with which rounding costs what it may, in fewest bits.

    An error of variance s^2 / 12 in each weight costs half its stiffness times that; at the optimum
    a bit less costs the same in every row. A row's step is its tensor's, which goes to the module's
    `steps`, times a power of two of at most `most`, its row shift: that is what files can say.
    What stands for a loss says too little of charts that are rare to round them more coarsely.
    """
    stiffness = torch.cat([root.diagonal().square() for root in roots])
    rows, count = module.rows[order], int(module.rows.max()) + 1
    counts = torch.bincount(rows, minlength=count).double()
    total = torch.bincount(rows, stiffness, minlength=count)
    allowed = quantization.lambda_ / (2 * math.log(2))
    steps = (24 * allowed / len(order) * counts / (total + TINY)).sqrt()
    steps.clamp_(config.finest, config.coarsest)
    if quantization.bit_budget:
        steps *= 2 ** _finer(module, order, steps, quantization.bit_budget, config)
    steps.clamp_(config.finest, config.coarsest)
    held = []
    for scale, found in zip(module.scales.values(), module.rows_of_tensors, strict=True):
        wanted, many = steps[found].numpy(), counts[found].numpy()
        step, row_shifts = shared_step(wanted, many, scale, most, config.step_resolution)
        steps[found] = torch.from_numpy(step * 2**row_shifts)
        held.append(step)
    module.steps = torch.tensor(held, dtype=torch.float64)
    return steps[module.rows]


def shared_step(
    steps: Float64Array, counts: Float64Array, scale: float, most: int, resolution: float
) -> tuple[float, Float64Array]:
    """One step for a tensor, and for each row a row shift, in place of `steps` of their own.

    counts      (rows,) weights in each row: what a step that is too fine or too coarse costs them
                in bits is weighed against the bits of row shifts
    scale       of which the step has few digits
    most        row shift
    resolution  of candidate steps, in octaves
    """
    wanted = np.log2(steps[counts > 0]) if counts.any() else np.zeros(1)
    first, last = float(wanted.min()), float(wanted.max())
    exponents = np.arange(first, min(last, first + MAX_ROW_SHIFT) + resolution, resolution)
    best: tuple[float, float, Float64Array] | None = None
    for step in sorted({snapped(2.0**exponent / scale) * scale for exponent in exponents.tolist()}):
        for width in range(most.bit_length() + 1 if len(steps) > 1 else 1):
            row_shifts = np.clip(np.rint(np.log2(steps / step)), 0, (1 << width) - 1)
            off = step * 2**row_shifts / steps
            bits = counts @ (off**2 / (2 * math.log(2)) - np.log2(off)) + width * len(steps)
            if best is None or bits < best[0]:
                best = float(bits), step, row_shifts
    assert best is not None
    return best[1:]


def _finer(
    module: Module, order: Tensor, steps: Tensor, budget: float, config: QuantizeConfig
) -> float:
    """How many octaves coarser (below 0: finer) `steps` of rows make weights fit into a budget.

    In bits, of all weights: n symbols of a tensor, of power p less what initial weights predict,
    take n softplus(2 x) / 2 bits, x = log2(sqrt(p)) + `GAUSSIAN_BITS`: a Gaussian's entropy, kept
    above 0.
    """
    tensors, grid = module.groups[order], steps[module.rows[order]]
    weights, first = module.weights.detach().cpu()[order].double(), module.first[order].double()
    share = torch.bincount(tensors, weights * first) / (torch.bincount(tensors, first**2) + TINY)
    counts = torch.bincount(tensors).double()
    power = torch.bincount(tensors, ((weights - share[tensors] * first) / grid).square())
    budget -= config.header_bits * len(counts)
    excess = torch.log2((power / counts.clamp(min=1)).clamp(min=TINY)) + 2 * GAUSSIAN_BITS
    low, high = -config.budget_range, config.budget_range
    while high - low > config.budget_tolerance:
        middle = (low + high) / 2
        bits = float(counts @ functional.softplus(excess - 2 * middle)) / 2
        low, high = (middle, high) if bits > budget else (low, middle)
    return high
