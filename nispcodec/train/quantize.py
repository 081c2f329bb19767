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
from nispcodec.train.task import Batch, Curvature, Rounding

SAMPLES, MOST_SAMPLES, DERIVATIVES = 8_000, 32_000, 60_000_000
"""Points that the second derivatives are a mean over: more where there are few weights."""
WHOLE, BLOCK = 5_000, 2_500
"""Weights of which all pairs are looked at together: of a whole network, or of a block of a larger
one. Beyond, memory and time run away."""

ENTRIES = 4_000_000
SHARES = 0.0, 0.1, 0.3, 1.0
"""Of Newton's step: beyond some way the outputs are no longer straight in the weights."""

HEAD = 52
"""Bits of what a file says of a tensor besides its symbols."""
GAUSSIAN_BITS = 0.5 * math.log2(2 * math.pi * math.e)
FINEST, COARSEST = 1e-6, 1e3
SIXTEENTHS = 1 / 16
OCTAVES, CLOSE = 32.0, 1e-3
TINY = 1e-30


def round_weights(
    module: Module, samples: Batch, rounding: Rounding, generator: torch.Generator
) -> None:
    """Put the weights on a grid, with a step for each row; what is pruned costs nothing."""
    count = min(max(DERIVATIVES // len(module.places), SAMPLES), MOST_SAMPLES)
    rows = torch.randperm(len(samples), generator=generator)[:count]
    batch = samples.chosen(rows.to(samples.points.device))
    rise = _Rise(module, batch, rounding.curvature)
    # The last of a block is rounded first: so it goes from the first layer to the last, in which
    # the outputs are linear and what went wrong before is made up for best.
    order = module.places.flip(0)
    blocks = torch.split(order, len(order) if len(order) <= WHOLE else BLOCK)
    roots = rise.roots(blocks, generator)
    grid = _grid(module, order, roots, rounding)
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

    def __init__(self, module: Module, batch: Batch, curvature: Curvature) -> None:
        self.module, self.batch, self.damping = module, batch, curvature.damping
        with torch.no_grad():
            self.first = module(batch.points, batch.chart)
            self.factors = curvature.factors(self.first, batch)

    def slope(self) -> Tensor:
        """Its derivatives by the weights, where they are now."""
        (slope,) = torch.autograd.grad(self(), self.module.weights)
        return slope.cpu().double()

    def least(self, places: Tensor, root: Tensor) -> Tensor:
        """Values in these places that make it least, as far as Newton's step leads there."""
        values = self.module.weights.detach().cpu().double()[places]
        slope = self.slope()[places]
        step = torch.cholesky_solve(slope[:, None], root, upper=True)[:, 0]
        return self.best(places, [values - share * step for share in SHARES])

    @torch.no_grad()
    def best(self, places: Tensor, candidates: Sequence[Tensor]) -> Tensor:
        """Of the candidates for these places that with the least rise, which is now there."""
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
        size = max(1, min(len(batch), ENTRIES // len(weights)))
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
    """Of each point's outputs along its direction (n, outputs) the derivatives (n, weights)."""

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


def _grid(module: Module, order: Tensor, roots: Sequence[Tensor], rounding: Rounding) -> Tensor:
    """Of each weight the step with which rounding costs what it may, in fewest bits.

    An error of variance s^2 / 12 in each weight costs half its stiffness times that; at the optimum
    a bit less costs the same in every row. A row's step is its tensor's, which goes to the module's
    `steps`, times a power of two, its octave: that is what files can say.
    """
    stiffness = torch.cat([root.diagonal().square() for root in roots])
    rows, count = module.rows[order], int(module.rows.max()) + 1
    counts = torch.bincount(rows, minlength=count).double()
    total = torch.bincount(rows, stiffness, minlength=count)
    allowed = rounding.price / (2 * math.log(2))
    steps = (24 * allowed / len(order) * counts / (total + TINY)).sqrt()
    steps.clamp_(FINEST, COARSEST)
    if rounding.budget:
        steps *= 2 ** _finer(module, order, steps, rounding.budget)
    steps.clamp_(FINEST, COARSEST)
    # What stands for a loss says too little of charts that are rare to round them more coarsely.
    most = MAX_ROW_SHIFT if rounding.curvature.own else 0
    held = []
    for scale, found in zip(module.scales.values(), module.rows_of_tensors, strict=True):
        step, octaves = shared_step(steps[found].numpy(), counts[found].numpy(), scale, most)
        steps[found] = torch.from_numpy(step * 2**octaves)
        held.append(step)
    module.steps = torch.tensor(held, dtype=torch.float64)
    return steps[module.rows]


def shared_step(
    steps: Float64Array, counts: Float64Array, scale: float, most: int
) -> tuple[float, Float64Array]:
    """One step for a tensor, and for each row an octave of it, in place of `steps` of their own.

    counts  (rows,) weights in each row: what a step that is too fine or too coarse costs them in
            bits is weighed against the bits of octaves
    scale   of which the step has few digits
    most    octaves
    """
    wanted = np.log2(steps[counts > 0]) if counts.any() else np.zeros(1)
    first, last = float(wanted.min()), float(wanted.max())
    exponents = np.arange(first, min(last, first + MAX_ROW_SHIFT) + SIXTEENTHS, SIXTEENTHS)
    best: tuple[float, float, Float64Array] | None = None
    for step in sorted({snapped(2.0**exponent / scale) * scale for exponent in exponents.tolist()}):
        for width in range(most.bit_length() + 1 if len(steps) > 1 else 1):
            octaves = np.clip(np.rint(np.log2(steps / step)), 0, (1 << width) - 1)
            off = step * 2**octaves / steps
            bits = counts @ (off**2 / (2 * math.log(2)) - np.log2(off)) + width * len(steps)
            if best is None or bits < best[0]:
                best = float(bits), step, octaves
    assert best is not None
    return best[1:]


def _finer(module: Module, order: Tensor, steps: Tensor, budget: float) -> float:
    """How many octaves coarser (below 0: finer) `steps` of rows make weights fit into a budget.

    In bits, of all weights: n symbols of a tensor, of power p less what first numbers tell of them,
    take n softplus(2 x) / 2 bits, x = log2(sqrt(p)) + `GAUSSIAN_BITS`: a Gaussian's entropy, kept
    above 0.
    """
    tensors, grid = module.groups[order], steps[module.rows[order]]
    weights, first = module.weights.detach().cpu()[order].double(), module.first[order].double()
    share = torch.bincount(tensors, weights * first) / (torch.bincount(tensors, first**2) + TINY)
    counts = torch.bincount(tensors).double()
    power = torch.bincount(tensors, ((weights - share[tensors] * first) / grid).square())
    budget -= HEAD * len(counts)
    excess = torch.log2((power / counts.clamp(min=1)).clamp(min=TINY)) + 2 * GAUSSIAN_BITS
    low, high = -OCTAVES, OCTAVES
    while high - low > CLOSE:
        middle = (low + high) / 2
        bits = float(counts @ functional.softplus(excess - 2 * middle)) / 2
        low, high = (middle, high) if bits > budget else (low, middle)
    return high
