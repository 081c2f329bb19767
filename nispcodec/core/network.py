"""Networks as data: their topology and their weights, as plain numpy arrays.

The one description that training, the format and the decoder share; evaluation is in
`nispcodec.infer.evaluate` (numpy) and `nispcodec.train.backend.torch.forward` (torch).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from nispcodec.core.arrays import Float32Array, Int64Array
from nispcodec.core.errors import FormatError
from nispcodec.core.initial_weights import initial_integers

ENCODINGS = ("identity", "fourier")
CONDITIONINGS = ("none", "scalar", "chart_affine")
TABLES = ("embedding", "slopes", "offsets")
"""Tensors with a row for each chart."""
ACTIVATIONS = ("sine", "relu")
OUTPUTS = ("identity", "tanh", "sigmoid")

MAX_WIDTH = 1024
MAX_HIDDEN_LAYERS = 32
MAX_CHARTS = 65_535
MAX_INIT_SEED = 2**32 - 1
MAX_ROW_SHIFT = 7


@dataclass(frozen=True)
class NetworkSpec:
    """Topology of one multilayer perceptron from a point in the normalized frame to `outputs`.

    encoding     "identity": x; "fourier": for each coordinate p, sin(2^i pi p), cos(2^i pi p) for
                 i = 0 ... levels-1 (paper, eq. 7), coordinate after coordinate
    conditioning how the chart number c of `charts` enters: "none"; "scalar": (2c + 1) / charts - 1
                 is a further coordinate, encoded like the others; "chart_affine": row c of a table
                 of `embedding` numbers a chart is appended to the encoded point, and an affine map
                 of the coordinates, row c of `slopes` and `offsets`, is added to what the last
                 layer gives
    hidden       widths of the hidden layers
    activation   "sine": sin(w0 (W x + b)); "relu": max(0, W x + b)
    output       activation of the last layer
    mirror       bit 0, 1, 2: of x, y, z the absolute value enters, before any encoding, so that the
                 network holds one half and its answers are symmetric about the plane; bit 3, 4, 5:
                 x, y, z itself follows as a further coordinate, for what differs on the two sides
    init_seed    seed of the initial weights (`nispcodec.core.initial_weights`)

    Raises FormatError for a member that is unknown or out of range.
    """

    hidden: tuple[int, ...]
    outputs: int
    encoding: str = "identity"
    levels: int = 0
    conditioning: str = "none"
    charts: int = 0
    embedding: int = 0
    activation: str = "sine"
    w0: float = 30.0
    output: str = "identity"
    mirror: int = 0
    init_seed: int = 0

    def __post_init__(self) -> None:
        _member("encoding", self.encoding, ENCODINGS)
        _member("conditioning", self.conditioning, CONDITIONINGS)
        _member("activation", self.activation, ACTIVATIONS)
        _member("output", self.output, OUTPUTS)
        _within("hidden", len(self.hidden), 1, MAX_HIDDEN_LAYERS)
        for width in self.hidden:
            _within("hidden", width, 1, MAX_WIDTH)
        _within("outputs", self.outputs, 1, MAX_CHARTS)
        fourier, conditioned = self.encoding == "fourier", self.conditioning != "none"
        _within("levels", self.levels, int(fourier), 16 if fourier else 0)
        _within("charts", self.charts, int(conditioned), MAX_CHARTS if conditioned else 0)
        affine = self.conditioning == "chart_affine"
        _within("embedding", self.embedding, int(affine), 64 if affine else 0)
        if not 0 < self.w0 <= 1000:
            raise FormatError("network", "w0", "a number in (0, 1000]", self.w0)
        _within("mirror", self.mirror, 0, 63)
        _within("init_seed", self.init_seed, 0, MAX_INIT_SEED)
        if self.mirror >> 3 & ~self.mirror:
            expected = "bits 3, 4, 5 only beside bits 0, 1, 2"
            raise FormatError("network", "mirror", expected, self.mirror)

    @property
    def mirrored(self) -> tuple[bool, bool, bool]:
        """Whether the absolute value enters in place of the coordinate, for each of x, y, z."""
        return bool(self.mirror & 1), bool(self.mirror & 2), bool(self.mirror & 4)

    @property
    def signed_axes(self) -> tuple[int, ...]:
        """The axes, 0 to 2, whose coordinate itself follows its absolute value."""
        return tuple(axis for axis in range(3) if self.mirror >> 3 + axis & 1)

    @property
    def coordinates(self) -> int:
        """How many coordinates of the point enter, before encoding."""
        return 3 + len(self.signed_axes)

    @property
    def inputs(self) -> int:
        """Width of the first layer's input, after encoding and conditioning."""
        coordinates = self.coordinates + (self.conditioning == "scalar")
        encoded = coordinates * (2 * self.levels if self.encoding == "fourier" else 1)
        return encoded + self.embedding

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Name and shape of every weight tensor, in file order."""
        widths = (self.inputs, *self.hidden, self.outputs)
        shapes: dict[str, tuple[int, ...]] = {}
        if self.conditioning == "chart_affine":
            shapes["embedding"] = (self.charts, self.embedding)
            shapes["slopes"] = (self.charts, self.outputs * self.coordinates)
            shapes["offsets"] = (self.charts, self.outputs)
        for layer, (fan_in, fan_out) in enumerate(pairwise(widths)):
            shapes[f"weight.{layer}"] = (fan_out, fan_in)
            shapes[f"bias.{layer}"] = (fan_out,)
        return shapes

    def initial_integers(self, names: Iterable[str]) -> dict[str, Int64Array]:
        """The initial weights of the tensors `names`, int64 as in `core.initial_weights`, by name.

        Each has the shape of its tensor in `shapes`.
        """
        shapes, first = self.shapes, 0
        places: dict[str, int] = {}
        for name, shape in shapes.items():
            places[name] = first
            first += math.prod(shape)
        counts = {name: math.prod(shapes[name]) for name in names}
        return {
            name: initial_integers(self.init_seed, places[name], count).reshape(shapes[name])
            for name, count in counts.items()
        }

    @property
    def weight_count(self) -> int:
        """How many numbers the network has, biases and tables included."""
        return sum(int(np.prod(shape)) for shape in self.shapes.values())


@dataclass(frozen=True)
class Network:
    """A spec with its weights: float32 arrays by the names and shapes of `spec.shapes`.

    `steps` names the tensors that are quantized, with their quantization step: such a tensor is
    float32(symbol) * float32(step) for integer symbols.
    Raises FormatError for tensors that do not fit the spec or are not finite.
    """

    spec: NetworkSpec
    tensors: Mapping[str, Float32Array]
    steps: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        shapes = self.spec.shapes
        if list(self.tensors) != list(shapes):
            raise FormatError("network", "tensors", list(shapes), list(self.tensors))
        for name, tensor in self.tensors.items():
            if tensor.shape != shapes[name] or tensor.dtype != np.float32:
                found = f"{tensor.dtype} {tensor.shape}"
                raise FormatError("network", name, f"float32 {shapes[name]}", found)
            if not np.isfinite(tensor).all():
                raise FormatError("network", name, "finite weights", "NaN or infinity")

    @property
    def layers(self) -> list[tuple[Float32Array, Float32Array]]:
        """(weight (out, in), bias (out,)) of every layer, first to last."""
        count = len(self.spec.hidden) + 1
        return [(self.tensors[f"weight.{i}"], self.tensors[f"bias.{i}"]) for i in range(count)]


def _member(name: str, value: str, allowed: tuple[str, ...]) -> None:
    if value not in allowed:
        raise FormatError("network", name, f"one of {', '.join(allowed)}", value)


def _within(name: str, value: int, low: int, high: int) -> None:
    if not low <= value <= high:
        raise FormatError("network", name, f"{low} to {high}", value)
