"""Where in one vector the weights of a network under training are.

Training moves all weights as one vector, in file order; sine layers hold w0 W and w0 b, which saves
a pass over the activations.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Float32Array, Float64Array, IndexArray
from nispcodec.core.network import TABLES, Network, NetworkSpec

PARTS = ("weight", "bias")


@dataclass(frozen=True)
class WeightLayout:
    """The vector of the weights of a spec: of what tensor, row and optimizer's matrix each is."""

    spec: NetworkSpec

    def parts(self, vector: AnyArray) -> dict[str, AnyArray]:
        """The tensors that a vector (weights,) holds, as views of their shapes, by name."""
        ends = np.cumsum(self._counts)[:-1]
        return {
            name: part.reshape(shape)
            for (name, shape), part in zip(
                self._shapes.items(), np.split(vector, ends), strict=True
            )
        }

    @cached_property
    def scales(self) -> dict[str, float]:
        """How many times a tensor of the file its part of the vector is: w0 in sine layers."""
        w0 = self.spec.w0 if self.spec.activation == "sine" else 1.0
        hidden = {f"{part}.{i}" for i in range(len(self.spec.hidden)) for part in PARTS}
        return {name: w0 if name in hidden else 1.0 for name in self._shapes}

    @cached_property
    def tensors(self) -> IndexArray:
        """(weights,) the number of each weight's tensor."""
        return np.repeat(np.arange(len(self._counts)), self._counts)

    @cached_property
    def rows(self) -> IndexArray:
        """(weights,) the number of each weight's row of a matrix; a bias is one row."""
        lengths = np.repeat([shape[-1] for shape in self._shapes.values()], self._rows_each)
        return np.repeat(np.arange(len(lengths)), lengths)

    @property
    def rows_of_tensors(self) -> list[slice]:
        """Which rows each tensor has."""
        ends = list(accumulate(self._rows_each))
        return [slice(end - rows, end) for end, rows in zip(ends, self._rows_each, strict=True)]

    @cached_property
    def layers(self) -> list[IndexArray]:
        """For each layer, where in the vector its [W | b] is: (out, in + 1)."""
        places = self.parts(np.arange(len(self.tensors)))
        return [
            np.concatenate([places[f"weight.{i}"], places[f"bias.{i}"][:, None]], axis=1)
            for i in range(len(self.spec.hidden) + 1)
        ]

    @cached_property
    def tables(self) -> IndexArray | None:
        """Where the tables are, side by side, a row for each chart; None without tables."""
        places = self.parts(np.arange(len(self.tensors)))
        found = [places[name] for name in TABLES if name in places]
        return np.concatenate(found, axis=1) if found else None

    def vector(self, tensors: Mapping[str, Float32Array]) -> Float32Array:
        """The vector (weights,) of a file's tensors."""
        scaled = [tensors[name] * np.float32(scale) for name, scale in self.scales.items()]
        return np.concatenate([tensor.ravel() for tensor in scaled])

    def network(self, weights: Float32Array, steps: Float64Array | None = None) -> Network:
        """The network of a vector; with a step for each tensor, each weight a symbol times it."""
        tensors: dict[str, Float32Array] = {}
        snapped: dict[str, float] = {}
        for number, (name, values) in enumerate(self.parts(weights).items()):
            scale = self.scales[name]
            if steps is None:
                tensors[name] = np.ascontiguousarray(values / np.float32(scale), np.float32)
                continue
            snapped[name] = step = four_bits(float(steps[number]) / scale)
            symbols = np.rint(values.astype(np.float64) / steps[number]).astype(np.float32)
            tensors[name] = symbols * np.float32(step)
        return Network(self.spec, tensors, snapped)

    def kept(self, mask: Mapping[str, BoolArray] | None) -> Float32Array | None:
        """(weights,) 1 for what a mask keeps and 0 for what it prunes; None without a mask."""
        if mask is None:
            return None
        found = np.ones(len(self.tensors), np.float32)
        for name, part in self.parts(found).items():
            if name in mask:
                part[:] = mask[name]
        return found

    @cached_property
    def _shapes(self) -> dict[str, tuple[int, ...]]:
        return self.spec.shapes

    @cached_property
    def _counts(self) -> list[int]:
        return [math.prod(shape) for shape in self._shapes.values()]

    @property
    def _rows_each(self) -> list[int]:
        return [math.prod(shape[:-1]) for shape in self._shapes.values()]


def four_bits(step: float) -> float:
    """The nearest number of four significant bits: what a file has for a step."""
    mantissa, exponent = math.frexp(step)
    return round(mantissa * 16) / 16 * 2.0**exponent
