"""The torch side of `nispcodec.network`: the same function, with gradients."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.fit.prune import Mask
from nispcodec.fit.quantise import FIRST_BITS, Quantiser, snapped
from nispcodec.network import Network, NetworkSpec, Weights


class Module:
    """A network under training.

    All its numbers are one vector, so that rounding, clipping and charging are one operation each.
    In it each layer is one matrix [W | b], so that a preconditioner sees weight and bias together,
    and an embedding is the last matrix. Sine layers hold w0 W and w0 b, which saves a pass over the
    activations. With a quantiser it computes with rounded weights, as the file will hold them.
    Once pruned, `kept` is 1 or 0 for each number, and what is pruned is 0 after every `hold`.
    `band` scales the frequencies that it starts with.
    """

    quantiser: Quantiser | None = None
    kept: Tensor | None = None

    def __init__(
        self, spec: NetworkSpec, generator: torch.Generator, device: str, band: float = 1.0
    ) -> None:
        self.spec = spec
        matrices = _initial_matrices(spec, generator)
        matrices[0] *= band
        table = torch.randn(spec.charts, max(spec.embedding, 1), generator=generator)
        parts = [*matrices, table] if spec.embedding else matrices
        self.mirrored = torch.tensor(spec.mirrored, device=device)
        self.shapes = [(part.shape[0], part.shape[1]) for part in parts]
        self.weights = torch.cat([part.flatten() for part in parts]).to(device).requires_grad_()

    @property
    def scales(self) -> list[float]:
        """What each matrix is a multiple of: w0 for sine layers."""
        sine = self.spec.w0 if self.spec.activation == "sine" else 1.0
        return [sine] * len(self.spec.hidden) + [1.0] * (1 + (self.spec.embedding > 0))

    def rates(self, last: float) -> list[float]:
        """Learning rate of each matrix relative to the schedule's; `last` is the last layer's."""
        rates = self.scales
        rates[len(self.spec.hidden)] = last
        return rates

    def __call__(self, points: Tensor, charts: Tensor | None = None) -> Tensor:
        """(n, 3) points, (n,) chart numbers -> (n, outputs)."""
        used = self.weights if self.kept is None else self.weights * self.kept
        used = used if self.quantiser is None else self.quantiser.rounded(used)
        parts = _matrices(used, self.shapes)
        layers = parts[: len(self.spec.hidden) + 1]
        hidden = self._encoded(points, charts, parts[-1])
        activation = torch.sin if self.spec.activation == "sine" else functional.relu
        for matrix in layers[:-1]:
            hidden = activation(_affine(matrix, hidden))
        return _OUTPUTS[self.spec.output](_affine(layers[-1], hidden))

    def prune(self, mask: Mask) -> None:
        """Keep what a mask keeps; the rest is 0 from now on."""
        self.kept = torch.ones_like(self.weights, requires_grad=False)
        parts = _matrices(self.kept, self.shapes)
        for name, index, columns in self._named():
            if name in mask:
                parts[index][:, columns] = torch.from_numpy(mask[name])
        self.hold()

    @torch.no_grad()
    def hold(self) -> None:
        """Make what is pruned 0 again, after a move."""
        if self.kept is not None:
            self.weights.mul_(self.kept)

    def quantise(self, bits: float = FIRST_BITS) -> None:
        """Compute with rounded weights from now on, at first of about so many bits each."""
        self.quantiser = Quantiser(self.weights, self._groups(), self.kept, bits)

    def network(self) -> Network:
        """The weights as they are now; with a quantiser each a symbol times its tensor's step."""
        tensors: dict[str, Weights] = {}
        steps: dict[str, float] = {}
        parts = _matrices(self.weights.detach(), self.shapes)
        for group, (name, index, columns) in enumerate(self._named()):
            values, scale = parts[index][:, columns], self.scales[index]
            if self.quantiser is None:
                tensors[name] = _array(values / scale)
                continue
            step = self.quantiser.steps[group]
            steps[name] = snapped(step.item() / scale)
            tensors[name] = _array((values / step).round()) * np.float32(steps[name])
        order = self.spec.shapes
        return Network(self.spec, {name: tensors[name] for name in order}, steps)

    def settle(self) -> None:
        """Hold the steps of the quantiser to those that a file can hold."""
        if self.quantiser is not None:
            self.quantiser.settle([self.scales[index] for _, index, _ in self._named()])

    def _named(self) -> Iterator[tuple[str, int, slice | int]]:
        """Name, matrix and columns of every tensor, as they follow each other in the vector."""
        for layer in range(len(self.spec.hidden) + 1):
            yield f"weight.{layer}", layer, slice(0, -1)
            yield f"bias.{layer}", layer, -1
        if self.spec.embedding:
            yield "embedding", len(self.spec.hidden) + 1, slice(None)

    def _groups(self) -> Tensor:
        """For each number of the vector that of its tensor."""
        groups = torch.zeros(len(self.weights), dtype=torch.long, device=self.weights.device)
        parts = _matrices(groups, self.shapes)
        for group, (_, index, columns) in enumerate(self._named()):
            parts[index][:, columns] = group
        return groups

    def _encoded(self, points: Tensor, charts: Tensor | None, table: Tensor) -> Tensor:
        spec = self.spec
        if spec.mirror:
            points = torch.where(self.mirrored, points.abs(), points)
        if spec.conditioning == "scalar" and charts is not None:
            scalar = (2 * charts[:, None] + 1) / spec.charts - 1
            points = torch.cat([points, scalar.to(points.dtype)], dim=1)
        if spec.encoding == "fourier":
            points = _fourier(points, spec.levels)
        if spec.embedding and charts is not None:
            points = torch.cat([points, functional.embedding(charts, table)], dim=1)
        return points


def _matrices(vector: Tensor, shapes: list[tuple[int, int]]) -> list[Tensor]:
    """The parts of a vector, as views of these shapes."""
    parts = torch.split(vector, [rows * columns for rows, columns in shapes])
    return [part.view(shape) for part, shape in zip(parts, shapes, strict=True)]


def _affine(matrix: Tensor, values: Tensor) -> Tensor:
    return torch.addmm(matrix[:, -1], values, matrix[:, :-1].T)


def _fourier(points: Tensor, levels: int) -> Tensor:
    """sin and cos of 2^i pi p for every coordinate p (paper, eq. 7)."""
    octaves = math.pi * 2.0 ** torch.arange(levels, dtype=points.dtype, device=points.device)
    angles = points[:, :, None] * octaves
    return torch.stack([angles.sin(), angles.cos()], dim=3).flatten(1)


def _initial_matrices(spec: NetworkSpec, generator: torch.Generator) -> list[Tensor]:
    widths = [spec.inputs, *spec.hidden, spec.outputs]
    matrices = []
    for layer, (fan_in, fan_out) in enumerate(pairwise(widths)):
        bound = _weight_bound(spec, layer, fan_in)
        weight = torch.rand(fan_out, fan_in, generator=generator) * 2 * bound - bound
        bias_bound = bound if layer < len(spec.hidden) else 0.0
        bias = torch.rand(fan_out, 1, generator=generator) * 2 * bias_bound - bias_bound
        matrices.append(torch.cat([weight, bias], dim=1))
    return matrices


def _weight_bound(spec: NetworkSpec, layer: int, fan_in: int) -> float:
    """SIREN's initialisation; He-uniform where w0 is 1 (the paper) and for relu."""
    if spec.activation == "relu" or spec.w0 == 1.0:
        return math.sqrt(6 / fan_in)
    if layer == 0:
        return spec.w0 / fan_in
    bound = math.sqrt(6 / fan_in)
    return bound if layer < len(spec.hidden) else bound / spec.w0


def _array(tensor: Tensor) -> Weights:
    return np.ascontiguousarray(tensor.detach().cpu().numpy(), dtype=np.float32)


_OUTPUTS = {"identity": lambda values: values, "tanh": torch.tanh, "sigmoid": torch.sigmoid}
