"""The torch side of `nispcodec.core.network`: the same function, with gradients."""

from __future__ import annotations

import math
from itertools import accumulate

import numpy as np
import torch
from torch import Tensor
from torch.nn import functional

from nispcodec.core.arrays import Float32Array
from nispcodec.core.initial_weights import BITS
from nispcodec.core.network import TABLES, Network, NetworkSpec
from nispcodec.train.backend.torch.stack import Matrices
from nispcodec.train.chart_affine import affine_maps
from nispcodec.train.prune import Mask


class Module:
    """A network under training.

    All its numbers are one vector, in file order, so that rounding, clipping and charging are one
    operation each. Sine layers hold w0 W and w0 b, which saves a pass over the activations. Once
    rounded (`nispcodec.train.quantize`), each tensor is a multiple of its step in `steps`. Once
    pruned, `kept` is 1 or 0 for each number, and what is pruned is 0 after every `apply_mask`.
    `w0_scale` scales the frequencies that it starts with; `first` are the initial weights.
    """

    steps: Tensor | None = None
    kept: Tensor | None = None

    def __init__(self, spec: NetworkSpec, device: str, w0_scale: float = 1.0) -> None:
        self.spec = spec
        self._shapes = spec.shapes
        self._counts = [math.prod(shape) for shape in self._shapes.values()]
        first = _initial(spec)
        first["weight.0"] *= w0_scale
        first["bias.0"] *= w0_scale
        if spec.encoding == "identity":
            first["weight.0"][:, 3 : 3 + len(spec.signed_axes)] = 0
        self.mirrored = torch.tensor(spec.mirrored, device=device)
        flat = [first[name].flatten() for name in self._shapes]
        self.first = torch.cat(flat)
        self.weights = self.first.clone().to(device).requires_grad_()

    @property
    def scales(self) -> dict[str, float]:
        """The factor of each tensor, by name: w0 in sine layers, 1 elsewhere."""
        w0 = self.spec.w0 if self.spec.activation == "sine" else 1.0
        hidden = {f"{part}.{i}" for i in range(len(self.spec.hidden)) for part in _PARTS}
        return {name: w0 if name in hidden else 1.0 for name in self.spec.shapes}

    def matrices(self, last: float) -> tuple[Matrices, Matrices]:
        """Matrices that an optimizer sees as one, and their rates relative to the schedule's.

        For each layer [W | b], for the tables a row for each chart: where its numbers are in the
        vector. First those from one hidden layer to the next, then all others; `last` is the rate
        of the last layer.
        """
        places = self._parts(torch.arange(len(self.weights)))
        count, scales = len(self.spec.hidden), self.scales
        layers = [
            (torch.cat([places[f"weight.{i}"], places[f"bias.{i}"][:, None]], dim=1), rate)
            for i, rate in enumerate([*(scales[f"weight.{i}"] for i in range(count)), last])
        ]
        tables = [places[name] for name in TABLES if name in places]
        rows = [(torch.cat(tables, dim=1), 1.0)] if tables else []
        return layers[1:-1], [layers[0], layers[-1], *rows]

    def place_chart_affine(self, points: Tensor, charts: Tensor, uvs: Tensor, ridge: float) -> None:
        """Start from the affine maps nearest to the UVs (n, 2) of points (n, 3) of charts (n,)."""
        seen = [part.cpu().numpy() for part in (self._coordinates(points), charts, uvs)]
        coordinates, numbers, targets = seen
        maps = affine_maps(
            coordinates.astype(np.float64),
            numbers,
            targets.astype(np.float64),
            self.spec.charts,
            ridge,
        )
        parts = self._parts(self.weights.detach())
        for name, values in zip(("slopes", "offsets"), maps, strict=True):
            parts[name].copy_(torch.from_numpy(values))

    def __call__(self, points: Tensor, charts: Tensor | None = None) -> Tensor:
        """(n, 3) points, (n,) chart numbers -> (n, outputs)."""
        used = self.weights if self.kept is None else self.weights * self.kept
        return self.outputs(used, points, charts)

    def outputs(self, weights: Tensor, points: Tensor, charts: Tensor | None) -> Tensor:
        """The same with other weights than its own."""
        parts = self._parts(weights)
        points = self._coordinates(points)
        rows = self._rows(parts, charts)
        hidden = self._encoded(points, charts, rows)
        activation = torch.sin if self.spec.activation == "sine" else functional.relu
        last = len(self.spec.hidden)
        for i in range(last):
            hidden = activation(functional.linear(hidden, parts[f"weight.{i}"], parts[f"bias.{i}"]))
        output = functional.linear(hidden, parts[f"weight.{last}"], parts[f"bias.{last}"])
        if self.spec.conditioning == "chart_affine":
            output = output + self._affine(points, rows)
        return _OUTPUTS[self.spec.output](output)

    def prune(self, mask: Mask) -> None:
        """Keep what a mask keeps; the rest is 0 from now on."""
        self.kept = torch.ones_like(self.weights, requires_grad=False)
        for name, part in self._parts(self.kept).items():
            if name in mask:
                part.copy_(torch.from_numpy(mask[name]))
        self.apply_mask()

    @torch.no_grad()
    def apply_mask(self) -> None:
        """Make what is pruned 0 again, after a step."""
        if self.kept is not None:
            self.weights.mul_(self.kept)

    @property
    def places(self) -> Tensor:
        """Where in the vector the numbers are that are not pruned."""
        everything = torch.arange(len(self.weights))
        return everything if self.kept is None else everything[self.kept.cpu() > 0]

    @property
    def groups(self) -> Tensor:
        """For each number of the vector that of its tensor."""
        counts = torch.tensor(self._counts)
        return torch.repeat_interleave(torch.arange(len(counts)), counts)

    @property
    def rows(self) -> Tensor:
        """For each number of the vector that of its matrix' row; a bias is one row."""
        lengths = [shape[-1] for shape in self._shapes.values()]
        every = torch.repeat_interleave(torch.tensor(lengths), torch.tensor(self._rows_each))
        return torch.repeat_interleave(torch.arange(len(every)), every)

    @property
    def rows_of_tensors(self) -> list[slice]:
        """Which rows each tensor has."""
        ends = list(accumulate(self._rows_each))
        return [slice(end - rows, end) for end, rows in zip(ends, self._rows_each, strict=True)]

    @property
    def _rows_each(self) -> list[int]:
        return [math.prod(shape[:-1]) for shape in self._shapes.values()]

    def network(self) -> Network:
        """The weights as they are now; once rounded, each a symbol times its tensor's step."""
        tensors: dict[str, Float32Array] = {}
        steps: dict[str, float] = {}
        for group, (name, values) in enumerate(self._parts(self.weights.detach()).items()):
            scale = self.scales[name]
            if self.steps is None:
                tensors[name] = _array(values / scale)
                continue
            step = float(self.steps[group])
            steps[name] = snapped(step / scale)
            tensors[name] = _array((values / step).round()) * np.float32(steps[name])
        return Network(self.spec, tensors, steps)

    def _parts(self, vector: Tensor) -> dict[str, Tensor]:
        """The tensors that a vector like `weights` holds, as views."""
        parts = zip(self._shapes.items(), torch.split(vector, self._counts), strict=True)
        return {name: part.view(shape) for (name, shape), part in parts}

    def _coordinates(self, points: Tensor) -> Tensor:
        if not self.spec.mirror:
            return points
        folded = torch.where(self.mirrored, points.abs(), points)
        return torch.cat(
            [folded, *(points[:, axis : axis + 1] for axis in self.spec.signed_axes)], dim=1
        )

    def _rows(self, parts: dict[str, Tensor], charts: Tensor | None) -> Tensor:
        """What the tables say of each point's chart, side by side."""
        tables = [parts[name] for name in TABLES if name in parts]
        if not tables or charts is None:
            return torch.zeros(0)
        return functional.embedding(charts, torch.cat(tables, dim=1))

    def _affine(self, points: Tensor, rows: Tensor) -> Tensor:
        """The affine map of each point's chart (n, outputs)."""
        outputs = self.spec.outputs
        slopes = rows[:, self.spec.embedding : -outputs].view(len(points), outputs, -1)
        return rows[:, -outputs:] + (slopes @ points[:, :, None])[:, :, 0]

    def _encoded(self, points: Tensor, charts: Tensor | None, rows: Tensor) -> Tensor:
        spec = self.spec
        if spec.conditioning == "scalar" and charts is not None:
            scalar = (2 * charts[:, None] + 1) / spec.charts - 1
            points = torch.cat([points, scalar.to(points.dtype)], dim=1)
        if spec.encoding == "fourier":
            points = _fourier(points, spec.levels)
        return torch.cat([points, rows[:, : spec.embedding]], dim=1) if spec.embedding else points


def _fourier(points: Tensor, levels: int) -> Tensor:
    """sin and cos of 2^i pi p for every coordinate p (paper, eq. 7)."""
    octaves = math.pi * 2.0 ** torch.arange(levels, dtype=points.dtype, device=points.device)
    angles = points[:, :, None] * octaves
    return torch.stack([angles.sin(), angles.cos()], dim=3).flatten(1)


def _initial(spec: NetworkSpec) -> dict[str, Tensor]:
    """Initial weights (`nispcodec.core.initial_weights`), each tensor within its bound."""
    bounds = _bounds(spec)
    return {
        name: torch.from_numpy(initial / (1 << BITS) * bounds[name]).float()
        for name, initial in spec.initial_integers(spec.shapes).items()
    }


def _bounds(spec: NetworkSpec) -> dict[str, float]:
    """How large the first numbers of every tensor are at most."""
    # Embeddings of variance 1.
    bounds = {"embedding": math.sqrt(3), "slopes": 0.0, "offsets": 0.0}
    for layer, fan_in in enumerate([spec.inputs, *spec.hidden]):
        bound = _weight_bound(spec, layer, fan_in)
        bias = bound if layer < len(spec.hidden) else 0.0
        bounds |= {f"weight.{layer}": bound, f"bias.{layer}": bias}
    return bounds


def _weight_bound(spec: NetworkSpec, layer: int, fan_in: int) -> float:
    """SIREN's initialization; He-uniform where w0 is 1 (the paper) and for relu."""
    if spec.activation == "relu" or spec.w0 == 1.0:
        return math.sqrt(6 / fan_in)
    if layer == 0:
        return spec.w0 / fan_in
    bound = math.sqrt(6 / fan_in)
    return bound if layer < len(spec.hidden) else bound / spec.w0


def snapped(step: float) -> float:
    """The nearest number of four significant bits."""
    mantissa, exponent = math.frexp(step)
    return round(mantissa * 16) / 16 * 2.0**exponent


def _array(tensor: Tensor) -> Float32Array:
    return np.ascontiguousarray(tensor.detach().cpu().numpy(), dtype=np.float32)


_PARTS = ("weight", "bias")
_OUTPUTS = {"identity": lambda values: values, "tanh": torch.tanh, "sigmoid": torch.sigmoid}
