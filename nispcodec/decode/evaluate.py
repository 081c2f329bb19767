"""Evaluation of a network in plain numpy: blocks of points on every core.

A block's activations are kept as (width, points) so that they fit a core's cache and the products
are `weight @ activations`; a sine layer's w0 is folded into its weights beforehand.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

from nispcodec.errors import QueryError
from nispcodec.network import Network, NetworkSpec

Floats = NDArray[np.float32]
Integers = NDArray[np.integer]

BLOCK = 4096


def evaluate(network: Network, points: Floats, charts: Integers | None = None) -> Floats:
    """The network's outputs at points of the normalised frame.

    points (n, 3) float32, normalised frame; charts (n,) integers, wanted by networks that are
    conditioned on the chart -> (n, outputs) float32. Any n, 0 included. Raises QueryError when a
    conditioned network gets no charts or charts that it does not know.
    """
    charts = _checked_charts(network.spec, len(points), charts)
    layers = _folded(network)
    result = np.empty((len(points), network.spec.outputs), np.float32)

    def block(part: slice) -> None:
        activations = _first(
            network, layers, points[part], None if charts is None else charts[part]
        )
        for weight, bias in layers[1:]:
            activations = weight @ _activated(network.spec, activations)
            activations += bias
        result[part] = _output(network.spec, activations).T

    _in_blocks(block, len(points))
    return result


def gradient(network: Network, points: Floats) -> tuple[Floats, Floats]:
    """Values and analytic gradients of a network with one output and no conditioning.

    points (n, 3) float32, normalised frame -> values (n,), gradients (n, 3), both float32.
    """
    layers = _folded(network)
    values = np.empty(len(points), np.float32)
    gradients = np.empty((len(points), 3), np.float32)

    def block(part: slice) -> None:
        values[part], gradients[part] = _block_gradient(network.spec, layers, points[part])

    _in_blocks(block, len(points))
    return values, gradients


Layers = list[tuple[Floats, Floats]]


def _block_gradient(spec: NetworkSpec, layers: Layers, points: Floats) -> tuple[Floats, Floats]:
    encoded = _encoded(spec, points.T)
    before: list[Floats] = []
    activations = encoded
    for weight, bias in layers[:-1]:
        before.append(weight @ activations + bias)
        activations = _activated(spec, before[-1].copy())
    weight, bias = layers[-1]
    value = _output(spec, weight @ activations + bias)
    slope = _output_slope(spec, value) * weight.T
    for (weight, _), preactivation in zip(reversed(layers[:-1]), reversed(before), strict=True):
        slope = weight.T @ (slope * _activation_slope(spec, preactivation))
    return value[0], _through_encoding(spec, encoded, slope).T


def _in_blocks(run: Callable[[slice], None], count: int) -> None:
    blocks = [slice(start, start + BLOCK) for start in range(0, count, BLOCK)]
    if len(blocks) < 2:
        for part in blocks:
            run(part)
        return
    # One BLAS thread a worker: BLAS's own threads would fight with the pool for the same cores.
    with _blas().limit(limits=1, user_api="blas"), ThreadPoolExecutor(_cores()) as pool:
        list(pool.map(run, blocks))


_controller: list[ThreadpoolController] = []


def _blas() -> ThreadpoolController:
    # Looking for the loaded BLAS libraries takes milliseconds: once a process.
    if not _controller:
        _controller.append(ThreadpoolController())
    return _controller[0]


def _cores() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _folded(network: Network) -> Layers:
    scale = np.float32(network.spec.w0 if network.spec.activation == "sine" else 1)
    *hidden, (weight, bias) = network.layers
    folded = [(w * scale, (b * scale)[:, None]) for w, b in hidden]
    return [*folded, (weight, bias[:, None])]


def _first(
    network: Network, layers: Layers, points: Floats, charts: NDArray[np.int32] | None
) -> Floats:
    spec = network.spec
    weight, bias = layers[0]
    coordinates = points.T
    if spec.conditioning == "scalar":
        assert charts is not None
        scalar = (2 * charts + 1).astype(np.float32) / np.float32(spec.charts) - np.float32(1)
        coordinates = np.vstack([coordinates, scalar])
    encoded = _encoded(spec, coordinates)
    result: Floats = weight[:, : len(encoded)] @ encoded
    if spec.conditioning == "embedding":
        assert charts is not None
        by_chart = weight[:, len(encoded) :] @ network.tensors["embedding"].T
        result += by_chart[:, charts]
    result += bias
    return result


def _encoded(spec: NetworkSpec, coordinates: Floats) -> Floats:
    if spec.encoding == "identity":
        return np.ascontiguousarray(coordinates)
    angles = _frequencies(spec)[:, None] * coordinates[:, None, :]
    waves = np.stack([np.sin(angles), np.cos(angles)], axis=2)
    return waves.reshape(-1, coordinates.shape[1])


def _through_encoding(spec: NetworkSpec, encoded: Floats, slope: Floats) -> Floats:
    if spec.encoding == "identity":
        return slope
    shape = (3, spec.levels, 2, -1)
    waves, slopes = encoded.reshape(shape), slope.reshape(shape)
    turned = slopes[:, :, 0] * waves[:, :, 1] - slopes[:, :, 1] * waves[:, :, 0]
    result: Floats = (turned * _frequencies(spec)[:, None]).sum(axis=1)
    return result


def _frequencies(spec: NetworkSpec) -> Floats:
    return np.array([np.pi * 2**level for level in range(spec.levels)], np.float32)


def _activated(spec: NetworkSpec, values: Floats) -> Floats:
    if spec.activation == "sine":
        return np.sin(values, out=values)
    return np.maximum(values, 0, out=values)


def _activation_slope(spec: NetworkSpec, before: Floats) -> Floats:
    # The factor w0 of a sine layer is already in the folded weights.
    return np.cos(before) if spec.activation == "sine" else (before > 0).astype(np.float32)


def _output(spec: NetworkSpec, values: Floats) -> Floats:
    if spec.output == "tanh":
        return np.tanh(values)
    if spec.output == "sigmoid":
        values = np.tanh(np.float32(0.5) * values)
        values += 1
        values *= 0.5
    return values


def _output_slope(spec: NetworkSpec, outputs: Floats) -> Floats:
    if spec.output == "tanh":
        return 1 - outputs * outputs
    if spec.output == "sigmoid":
        return outputs * (1 - outputs)
    return np.ones_like(outputs)


def _checked_charts(
    spec: NetworkSpec, count: int, charts: Integers | None
) -> NDArray[np.int32] | None:
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
