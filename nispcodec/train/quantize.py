"""Rounding whose errors cancel: what one weight is off by, those not rounded yet make up for.

Weights on a grid are sought that raise the loss least, by its second derivatives (Gauss-Newton):
the nearest plane of Babai, "On Lovasz' lattice reduction and the nearest lattice point problem",
1986; found again as optimal brain compression and GPTQ (Frantar et al. 2022). Of a small network
the second derivatives are known whole, or in large blocks.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from nispcodec.core.arrays import Float32Array, Float64Array, FloatArray, IndexArray
from nispcodec.core.errors import FitError
from nispcodec.core.network import MAX_ROW_SHIFT
from nispcodec.core.sample_set import SampleSet
from nispcodec.train.backend.protocol import Trainer
from nispcodec.train.config import QuantizeConfig
from nispcodec.train.layout import WeightLayout, four_bits
from nispcodec.train.task import Quantization, Task
from nispcodec.train.triangle import Triangle

TINY = 1e-30


@dataclass(frozen=True)
class Unrounded:
    """A fitted network, and what evaluates it.

    weights  (weights,) the best of the fit
    first    (weights,) those that it started from, which the decoder knows
    kept     (weights,) 0 for what is pruned; None: nothing is
    """

    task: Task
    layout: WeightLayout
    trainer: Trainer
    weights: Float32Array
    first: Float32Array
    kept: Float32Array | None = None

    @property
    def places(self) -> IndexArray:
        """Where in the vector the weights are that are not pruned."""
        return np.arange(len(self.weights)) if self.kept is None else np.flatnonzero(self.kept)


def round_weights(
    unrounded: Unrounded, quantization: Quantization, random: np.random.Generator
) -> tuple[Float32Array, Float64Array]:
    """Weights on a grid with a step for each row (weights,), and the steps of tensors (tensors,).

    What is pruned stays 0 and costs nothing. Raises FitError for weights that are not finite.
    """
    config, objective = unrounded.task.config.quantize, unrounded.task.objective
    wanted = config.derivatives // len(unrounded.places)
    count = min(max(wanted, config.least_samples), config.most_samples)
    samples = unrounded.task.samples
    rise = _Rise(unrounded, samples[random.permutation(len(samples))[:count]], config)
    # The last of a block is rounded first: so it goes from the first layer to the last, in which
    # the outputs are linear and what went wrong before is made up for best.
    order = np.ascontiguousarray(unrounded.places[::-1])
    blocks = _blocks(order, len(order) if len(order) <= config.whole else config.block)
    roots = rise.roots(blocks, random)
    most = MAX_ROW_SHIFT if objective.own_curvature else 0
    grid, steps = _grid(unrounded, order, roots, quantization, most)
    for places, root in zip(reversed(blocks), reversed(roots), strict=True):
        rise.round(places, root.square(), grid[places])
    return rise.weights, steps


def nearest(values: Float64Array, root: FloatArray, sizes: Float64Array) -> Float64Array:
    """Multiples x (n,) of their `sizes` (n,) for which |root (x - values)| is small.

    root  (n, n) upper triangular; what is below its diagonal is not looked at
    """
    found, pulls = np.zeros_like(values), np.zeros_like(values)
    stiffness = np.diag(root).astype(np.float64)
    for i in reversed(range(len(values))):
        wanted = values[i] + pulls[i] / stiffness[i]
        found[i] = np.rint(wanted / sizes[i]) * sizes[i]
        # A column at a time: as the memory of a root from LAPACK has them.
        pulls[:i] += root[:i, i] * (values[i] - found[i])
    return found


def _blocks(order: IndexArray, size: int) -> list[IndexArray]:
    """Parts of about the same size, of `size` weights at most."""
    return np.array_split(order, -(-len(order) // size))


class _Rise:
    """How much the loss rises: half the square of how far the outputs are from where they were."""

    def __init__(self, unrounded: Unrounded, samples: SampleSet, config: QuantizeConfig) -> None:
        self.weights = unrounded.weights.copy()
        self._trainer, self._samples, self._config = unrounded.trainer, samples, config
        self._damping = unrounded.task.objective.damping
        self._first = self._outputs()
        self._factors = unrounded.task.objective.factors(self._first, samples).astype(np.float32)

    def round(self, places: IndexArray, root: Float32Array, sizes: Float64Array) -> None:
        """Put the weights in these places on a grid of these sizes."""
        values = self._least(places, root)
        # Steps so coarse that the rise is no square any more: then each weight by itself.
        alone = np.rint(values / sizes) * sizes
        self._best(places, [nearest(values, root, sizes), alone])

    def roots(self, blocks: Sequence[IndexArray], random: np.random.Generator) -> list[Triangle]:
        """Upper Cholesky factors of its second derivatives, block by block."""
        # One direction for each point in place of all, right in the mean.
        signs = random.integers(0, 2, self._factors.shape[::2]) * 2.0 - 1
        directions = _along(self._factors, signs.astype(np.float32))
        found = [Triangle.zeros(len(block)) for block in blocks]
        for slopes in self._slopes(directions):
            for block, triangle in zip(blocks, found, strict=True):
                triangle.add(slopes.take(block, axis=1), 1 / len(self._samples))
        for triangle in found:
            # The fewer points a weight, the less of how weights hang together is more than chance.
            ridge = self._config.ridge * (triangle.size / len(self._samples)) ** 2
            _factor(triangle, ridge, self._damping)
        return found

    def _least(self, places: IndexArray, root: Float32Array) -> Float64Array:
        """Values in these places that make it least, as far as Newton's step leads there."""
        values, off = self.weights[places].astype(np.float64), self._off()
        if not off.any():
            return values
        parts = self._slopes(_along(self._factors, off), places)
        slope = sum((part.sum(axis=0) for part in parts), np.zeros(len(places), np.float32))
        step, _ = lapack.spotrs(root, slope / np.float32(len(self._samples)))
        return self._best(places, [values - share * step for share in self._config.newton_shares])

    def _best(self, places: IndexArray, candidates: Sequence[Float64Array]) -> Float64Array:
        """The candidate for these places with the least rise, which is now there."""
        rises = []
        for values in candidates:
            self.weights[places] = values
            rises.append(float(np.square(self._off()).sum()))
        chosen = candidates[int(np.argmin(rises))]
        self.weights[places] = chosen
        return chosen

    def _slopes(
        self, directions: Float32Array, places: IndexArray | None = None
    ) -> Iterator[Float32Array]:
        """Derivatives (some points, weights) of the outputs along directions (n, outputs).

        By the weights in `places`, or by all.
        """
        size = max(1, self._config.entries // len(self.weights))
        for start in range(0, len(self._samples), size):
            part, along = self._samples[start : start + size], directions[start : start + size]
            yield self._trainer.slopes(self.weights, part.points, part.chart, along, places)

    def _off(self) -> Float32Array:
        """How far the outputs are from where they were, by the factors' columns (n, r)."""
        return np.einsum("nk,nkr->nr", self._outputs() - self._first, self._factors)

    def _outputs(self) -> Float32Array:
        return self._trainer.outputs(self.weights, self._samples.points, self._samples.chart)


def _along(factors: Float32Array, amounts: Float32Array) -> Float32Array:
    """So much (n, r) of each column of the factors (n, k, r): (n, k)."""
    return np.ascontiguousarray((factors @ amounts[:, :, None])[:, :, 0], dtype=np.float32)


def _factor(triangle: Triangle, ridge: float, damping: float) -> None:
    """Replace a square by its upper Cholesky factor.

    Its diagonal is raised by the share `ridge`, and by `damping` times its mean: ten times both,
    until there is a factor. Raises FitError for a square that is not finite.
    """
    while True:
        square = triangle.square()
        diagonal = np.diag(square)
        mean = float(diagonal.mean()) + TINY
        if not math.isfinite(mean):
            raise FitError("weights cannot be rounded: expected finite derivatives, found NaN")
        square[np.diag_indices(len(square))] = (1 + ridge) * diagonal + damping * mean
        root, failed = lapack.spotrf(square, lower=0, clean=0, overwrite_a=True)
        if not failed:
            triangle.set(root)
            return
        ridge, damping = 10 * ridge, 10 * damping


def _grid(
    unrounded: Unrounded,
    order: IndexArray,
    roots: Sequence[Triangle],
    quantization: Quantization,
    most: int,
) -> tuple[Float64Array, Float64Array]:
    """The step of each weight (weights,), and of each tensor: rounding then costs what it may.

    An error of variance s^2 / 12 in each weight costs half its stiffness times that; at the optimum
    a bit less costs the same in every row. A row's step is its tensor's times a power of two of at
    most `most`, its row shift: that is what files can say. What stands for a loss says too little
    of charts that are rare to round them more coarsely.
    """
    layout, config = unrounded.layout, unrounded.task.config.quantize
    stiffness = np.concatenate([np.diag(root.square()).astype(np.float64) ** 2 for root in roots])
    rows, count = layout.rows[order], int(layout.rows.max()) + 1
    counts = np.bincount(rows, minlength=count).astype(np.float64)
    total = np.bincount(rows, stiffness, minlength=count)
    allowed = quantization.lambda_ / (2 * math.log(2))
    steps = np.sqrt(24 * allowed / len(order) * counts / (total + TINY)) * 2**quantization.coarser
    steps = steps.clip(config.finest, config.coarsest)
    held = []
    for scale, found in zip(layout.scales.values(), layout.rows_of_tensors, strict=True):
        step, row_shifts = shared_step(
            steps[found], counts[found], scale, most, config.step_resolution
        )
        steps[found] = step * 2**row_shifts
        held.append(step)
    return steps[layout.rows], np.array(held)


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
    for step in sorted(
        {four_bits(2.0**exponent / scale) * scale for exponent in exponents.tolist()}
    ):
        for width in range(most.bit_length() + 1 if len(steps) > 1 else 1):
            row_shifts = np.clip(np.rint(np.log2(steps / step)), 0, (1 << width) - 1)
            off = step * 2**row_shifts / steps
            bits = counts @ (off**2 / (2 * math.log(2)) - np.log2(off)) + width * len(steps)
            if best is None or bits < best[0]:
                best = float(bits), step, row_shifts
    assert best is not None
    return best[1:]
