"""Evaluation of a network in plain numpy: blocks of points on every core.

A block's activations are kept as (width + 1, points), the last row being ones: a layer is then one
matrix product with `[weight | bias]`, and a block fits a core's cache. A sine layer's w0 is folded
into its weights beforehand.
"""

from __future__ import annotations

from collections.abc import Callable
from threading import local

import numpy as np

from nispcodec.core.arrays import Float32Array, Int32Array, IntArray
from nispcodec.core.errors import QueryError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.infer.parallel import parallel_for

# Bytes of two layers' activations of a block: they stay in a core's cache. Smaller blocks cost more
# calls than they save, and threads wait for each other at every call.
CACHE = 1 << 20
SMALLEST = 64
# Numbers that a block gives at most, 16 MB: a file may have 65,535 charts.
MOST_OUTPUTS = 1 << 22


def evaluate(
    network: Network, points: Float32Array, charts: IntArray | None = None
) -> Float32Array:
    """The network's outputs at points of the normalized frame.

    points (n, 3) float32, normalized frame; charts (n,) integers, wanted by networks that are
    conditioned on the chart -> (n, outputs) float32. Any n, 0 included. Raises QueryError when a
    conditioned network gets no charts or charts that it does not know.
    """
    known = _checked_charts(network.spec, len(points), charts)
    result = np.empty((len(points), network.spec.outputs), np.float32)
    forward = _Forward(network)

    def block(part: slice) -> None:
        result[part] = forward(points[part], None if known is None else known[part]).T

    _in_blocks(block, network.spec, len(points))
    return result


def classify(network: Network, points: Float32Array, among: int | None = None) -> Int32Array:
    """The number of the largest output at each point: (n, 3) float32 -> (n,) int32.

    `among`: only so many outputs, the first ones, are looked at.
    """
    result = np.empty(len(points), np.int32)
    forward = _Forward(network)

    def block(part: slice) -> None:
        result[part] = _largest(forward(points[part], None)[:among])

    _in_blocks(block, network.spec, len(points))
    return result


def contrast(
    network: Network, points: Float32Array, first: Int32Array, second: Int32Array
) -> Float32Array:
    """Output `first` minus output `second` at each point: (n, 3), (n,), (n,) -> (n,) float32."""
    result = np.empty(len(points), np.float32)
    forward = _Forward(network)

    def block(part: slice) -> None:
        outputs = forward(points[part], None)
        columns = np.arange(outputs.shape[1])
        result[part] = outputs[first[part], columns] - outputs[second[part], columns]

    _in_blocks(block, network.spec, len(points))
    return result


def gradient(network: Network, points: Float32Array) -> tuple[Float32Array, Float32Array]:
    """Values and analytic gradients of a network with one output and no conditioning.

    points (n, 3) float32, normalized frame -> values (n,), gradients (n, 3), both float32. On the
    plane of a mirror the gradient lies in it: the mean of those on either side.
    """
    values = np.empty(len(points), np.float32)
    gradients = np.empty((len(points), 3), np.float32)
    forward = _Forward(network)

    def block(part: slice) -> None:
        values[part], gradients[part] = forward.with_gradient(points[part])

    _in_blocks(block, network.spec, len(points))
    return values, gradients


class _Forward:
    """A network made ready for evaluation: call it with one block of points."""

    def __init__(self, network: Network) -> None:
        self.spec = network.spec
        sine = self.spec.activation == "sine"
        scales = [self.spec.w0 if sine else 1.0] * len(self.spec.hidden) + [1.0]
        self.layers = [
            _folded(weight, bias, np.float32(scale))
            for (weight, bias), scale in zip(network.layers, scales, strict=True)
        ]
        self.embedding: Float32Array | None = None
        self.frames: Float32Array | None = None
        if self.spec.conditioning == "chart_affine":
            self.embedding = np.ascontiguousarray(network.tensors["embedding"].T)
            self.frames = _frames(network)
        self.mirrored = np.array(self.spec.mirrored)[:, None]
        self._own = local()

    def __call__(self, points: Float32Array, charts: Int32Array | None) -> Float32Array:
        """Outputs (outputs, n) at points (n, 3); NaN and infinities where they overflow."""
        with np.errstate(over="ignore", invalid="ignore"):
            return self._outputs(points, charts)

    def _outputs(self, points: Float32Array, charts: Int32Array | None) -> Float32Array:
        activations = self._input(points, charts)
        buffers = self._buffers(2, len(points))
        for index, layer in enumerate(self.layers[:-1]):
            following = _before(layer, activations, buffers[index % 2])
            self._activate(following[:-1])
            activations = following
        outputs = self.layers[-1] @ activations
        if self.frames is not None and charts is not None:
            outputs += self._framed(points, charts)
        return self._output(outputs)

    def _framed(self, points: Float32Array, charts: Int32Array) -> Float32Array:
        """The affine map of each point's chart (outputs, n)."""
        assert self.frames is not None
        coordinates = self._coordinates(points)
        slopes = self.frames.take(charts, axis=2)
        framed = slopes[:, -1]
        for axis, coordinate in enumerate(coordinates):
            framed += slopes[:, axis] * coordinate
        return framed

    def _buffers(self, layers: int, count: int) -> Float32Array:
        """Room for (layers, width + 1, count), the thread's own: new memory costs time."""
        size = layers * (max(self.spec.hidden) + 1) * count
        room: Float32Array | None = getattr(self._own, "room", None)
        if room is None or room.size < size:
            room = self._own.room = np.empty(size, np.float32)
        return room[:size].reshape(layers, -1, count)

    def with_gradient(self, points: Float32Array) -> tuple[Float32Array, Float32Array]:
        """Values (n,) and gradients (n, 3) by one pass forwards and one backwards."""
        activations = encoded = self._input(points, None)
        buffers = self._buffers(2 + len(self.spec.hidden), len(points))
        slopes: list[Float32Array] = []
        for index, layer in enumerate(self.layers[:-1]):
            following = _before(layer, activations, buffers[index % 2])
            slopes.append(buffers[2 + index, : len(layer)])
            self._activation_slope(following[:-1], slopes[-1])
            self._activate(following[:-1])
            activations = following
        value = self._output(self.layers[-1] @ activations)
        slope = self.layers[-1][:, :-1].T * self._output_slope(value)
        for layer, steep in zip(reversed(self.layers[:-1]), reversed(slopes), strict=True):
            slope = layer[:, :-1].T @ np.multiply(slope, steep, out=steep)
        slope = self._through_encoding(encoded[:-1], slope)
        if self.spec.mirror:
            slope = self._through_mirror(points.T, slope)
        return value[0], slope.T

    def _input(self, points: Float32Array, charts: Int32Array | None) -> Float32Array:
        coordinates = self._coordinates(points)
        if self.spec.conditioning == "scalar" and charts is not None:
            scalar = (2 * charts + 1).astype(np.float32) / np.float32(self.spec.charts) - 1
            coordinates = np.vstack([coordinates, scalar.astype(np.float32)])
        if self.spec.encoding == "fourier":
            angles = self._frequencies[:, None] * coordinates[:, None, :]
            waves = np.stack([np.sin(angles), np.cos(angles)], axis=2)
            coordinates = waves.reshape(-1, len(points))
        rows = np.empty((len(coordinates) + self.spec.embedding + 1, len(points)), np.float32)
        rows[: len(coordinates)], rows[-1] = coordinates, 1
        if self.embedding is not None and charts is not None:
            rows[len(coordinates) : -1] = self.embedding.take(charts, axis=1)
        return rows

    def _coordinates(self, points: Float32Array) -> Float32Array:
        """What of the points (n, 3) enters: (3, n), and a row for each coordinate that follows."""
        coordinates = points.T
        if not self.spec.mirror:
            return coordinates
        folded = np.where(self.mirrored, np.abs(coordinates), coordinates)
        return np.vstack([folded, coordinates[list(self.spec.signed_axes)]])

    def _through_encoding(self, encoded: Float32Array, slope: Float32Array) -> Float32Array:
        if self.spec.encoding == "identity":
            return slope
        shape = (-1, self.spec.levels, 2, slope.shape[1])
        waves, slopes = encoded.reshape(shape), slope.reshape(shape)
        turned = slopes[:, :, 0] * waves[:, :, 1] - slopes[:, :, 1] * waves[:, :, 0]
        result: Float32Array = (turned * self._frequencies[:, None]).sum(axis=1)
        return result

    def _through_mirror(self, coordinates: Float32Array, slope: Float32Array) -> Float32Array:
        folded = np.where(self.mirrored, slope[:3] * np.sign(coordinates), slope[:3])
        folded[list(self.spec.signed_axes)] += slope[3:]
        return folded

    @property
    def _frequencies(self) -> Float32Array:
        return np.array([np.pi * 2**level for level in range(self.spec.levels)], np.float32)

    def _activate(self, values: Float32Array) -> None:
        if self.spec.activation == "sine":
            np.sin(values, out=values)
        else:
            np.maximum(values, 0, out=values)

    def _activation_slope(self, before: Float32Array, out: Float32Array) -> None:
        # The factor w0 of a sine layer is already in the folded weights.
        if self.spec.activation == "sine":
            np.cos(before, out=out)
        else:
            np.greater(before, 0, out=out)

    def _output(self, values: Float32Array) -> Float32Array:
        if self.spec.output == "tanh":
            return np.tanh(values)
        if self.spec.output == "sigmoid":
            values = np.tanh(np.float32(0.5) * values)
            values += 1
            values *= 0.5
        return values

    def _output_slope(self, outputs: Float32Array) -> Float32Array:
        if self.spec.output == "tanh":
            return 1 - outputs * outputs
        if self.spec.output == "sigmoid":
            return outputs * (1 - outputs)
        return np.ones_like(outputs)


def _largest(outputs: Float32Array) -> IntArray:
    """The first row that is largest in each column, (rows, n) -> (n,).

    As argmax does, in a fifth to three fifths of its time: down columns argmax goes one by one.
    """
    count = len(outputs)
    numbers = np.arange(count, 0, -1).astype(np.min_scalar_type(count))
    largest = ~(outputs < outputs.max(axis=0))
    return count - (largest.view(np.uint8) * numbers[:, None]).max(axis=0)


def _before(layer: Float32Array, activations: Float32Array, room: Float32Array) -> Float32Array:
    """A layer's values before its activation, in `room`: (width + 1, n), the last row ones."""
    following = room[: len(layer) + 1]
    following[-1] = 1
    np.matmul(layer, activations, out=following[:-1])
    return following


def _folded(weight: Float32Array, bias: Float32Array, scale: np.float32) -> Float32Array:
    """(out, in + 1): `[weight | bias]`, scaled."""
    layer = np.empty((len(bias), weight.shape[1] + 1), np.float32)
    np.multiply(weight, scale, out=layer[:, :-1])
    np.multiply(bias, scale, out=layer[:, -1])
    return layer


def _frames(network: Network) -> Float32Array:
    """(outputs, coordinates + 1, charts): the slopes of each output, then its offset."""
    slopes, offsets = network.tensors["slopes"], network.tensors["offsets"]
    each = slopes.reshape(len(slopes), network.spec.outputs, -1)
    rows = np.concatenate([each, offsets[:, :, None]], axis=2)
    return np.ascontiguousarray(np.moveaxis(rows, 0, 2))


def _in_blocks(run: Callable[[slice], None], spec: NetworkSpec, count: int) -> None:
    size = block_size(spec)
    parallel_for(run, [slice(start, start + size) for start in range(0, count, size)])


def block_size(spec: NetworkSpec) -> int:
    """How many points are evaluated at a time: fewer where a network has thousands of outputs."""
    return min(max(CACHE // (8 * max(spec.hidden)), SMALLEST), max(MOST_OUTPUTS // spec.outputs, 1))


def _checked_charts(spec: NetworkSpec, count: int, charts: IntArray | None) -> Int32Array | None:
    if spec.conditioning == "none":
        return None
    if charts is None or charts.shape != (count,):
        found = "none" if charts is None else f"shape {charts.shape}"
        raise QueryError(f"charts: expected one for each of {count} points, found {found}")
    if count and (charts.min() < 0 or charts.max() >= spec.charts):
        raise QueryError(
            f"charts: expected 0 to {spec.charts - 1}, found {charts.min()} to {charts.max()}"
        )
    return charts.astype(np.int32)
