"""The torch side of `nispcodec.network`: the same function, with gradients."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.fit.quantise import Quantiser, snapped
from nispcodec.network import Network, NetworkSpec, Weights


class Module:
    """A network under training.

    Each layer is one matrix [W | b], so that a preconditioner sees weight and bias together. Sine
    layers hold w0 W and w0 b, which saves a pass over the activations. With a quantiser it computes
    with rounded weights, as the file will hold them.
    """

    quantiser: Quantiser | None = None

    def __init__(self, spec: NetworkSpec, generator: torch.Generator, device: str) -> None:
        self.spec = spec
        matrices = _initial_matrices(spec, generator)
        self.matrices = [matrix.to(device).requires_grad_() for matrix in matrices]
        table = torch.randn(spec.charts, max(spec.embedding, 1), generator=generator)
        self.table = table.to(device).requires_grad_() if spec.embedding else None

    @property
    def parameters(self) -> list[Tensor]:
        """Every matrix, first layer first, then the embedding if there is one."""
        return self.matrices if self.table is None else [*self.matrices, self.table]

    @property
    def rates(self) -> list[float]:
        """Learning rate of each parameter relative to the schedule's."""
        sine = self.spec.w0 if self.spec.activation == "sine" else 1.0
        rates = [sine] * len(self.spec.hidden) + [1.0]
        return rates if self.table is None else [*rates, 1.0]

    def __call__(self, points: Tensor, charts: Tensor | None = None) -> Tensor:
        """(n, 3) points, (n,) chart numbers -> (n, outputs)."""
        matrices, table = self._used()
        hidden = self._encoded(points, charts, table)
        activation = torch.sin if self.spec.activation == "sine" else functional.relu
        for matrix in matrices[:-1]:
            hidden = activation(_affine(matrix, hidden))
        return _OUTPUTS[self.spec.output](_affine(matrices[-1], hidden))

    def quantise(self) -> None:
        """Compute with rounded weights from now on."""
        self.quantiser = Quantiser(self.matrices, self.table)

    def network(self) -> Network:
        """The weights as they are now; with a quantiser each a symbol times its tensor's step."""
        tensors: dict[str, Weights] = {}
        steps: dict[str, float] = {}
        for name, index, columns in self._named():
            values, rate = self.parameters[index].detach()[:, columns], self.rates[index]
            if self.quantiser is None:
                tensors[name] = _array(values / rate)
                continue
            step = self.quantiser.steps(index)[columns].reshape(-1)[0]
            steps[name] = snapped(step.item() / rate)
            tensors[name] = _array((values / step).round()) * np.float32(steps[name])
        return Network(self.spec, tensors, steps)

    def _named(self) -> Iterator[tuple[str, int, slice | int]]:
        """Name, parameter and columns of every tensor, in file order."""
        if self.table is not None:
            yield "embedding", len(self.matrices), slice(None)
        for layer in range(len(self.matrices)):
            yield f"weight.{layer}", layer, slice(0, -1)
            yield f"bias.{layer}", layer, -1

    def _used(self) -> tuple[list[Tensor], Tensor | None]:
        """The matrices and the embedding that the function is computed with."""
        if self.quantiser is None:
            return self.matrices, self.table
        used = self.quantiser.rounded(self.parameters)
        return used[: len(self.matrices)], None if self.table is None else used[-1]

    def _encoded(self, points: Tensor, charts: Tensor | None, table: Tensor | None) -> Tensor:
        spec = self.spec
        if spec.conditioning == "scalar" and charts is not None:
            scalar = (2 * charts[:, None] + 1) / spec.charts - 1
            points = torch.cat([points, scalar.to(points.dtype)], dim=1)
        if spec.encoding == "fourier":
            points = _fourier(points, spec.levels)
        if table is not None and charts is not None:
            points = torch.cat([points, functional.embedding(charts, table)], dim=1)
        return points


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
