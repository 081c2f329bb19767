"""The numpy evaluation against a plain reading of the specification, point by point."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from threadpoolctl import threadpool_info

from nispcodec.core.errors import QueryError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.infer.evaluate import block_size, classify, evaluate, gradient
from tests import tiny

SPECS = {
    "siren": NetworkSpec((16, 12), 3, w0=30.0),
    "relu fourier tanh": NetworkSpec(
        (16,), 1, encoding="fourier", levels=5, activation="relu", output="tanh"
    ),
    "scalar fourier": NetworkSpec(
        (8, 8), 2, encoding="fourier", levels=3, conditioning="scalar", charts=7, w0=1.0
    ),
    "scalar identity": NetworkSpec((8,), 2, conditioning="scalar", charts=7, output="sigmoid"),
    "frames fourier": NetworkSpec(
        (8,), 2, encoding="fourier", levels=2, conditioning="chart_affine", charts=5, embedding=3
    ),
    "frames": NetworkSpec((8, 8), 2, conditioning="chart_affine", charts=5, embedding=3, w0=2.0),
    "frames sided": NetworkSpec(
        (8,),
        2,
        conditioning="chart_affine",
        charts=5,
        embedding=3,
        mirror=0b010110,
        output="sigmoid",
    ),
    "mirror": NetworkSpec((8, 8), 1, w0=2.0, mirror=0b101),
    "mirror scalar fourier": NetworkSpec(
        (8,), 2, encoding="fourier", levels=2, conditioning="scalar", charts=7, mirror=0b110
    ),
    "sided": NetworkSpec((8, 8), 1, w0=2.0, mirror=0b101101),
    "sided scalar fourier": NetworkSpec(
        (8,), 2, encoding="fourier", levels=2, conditioning="scalar", charts=7, mirror=0b010110
    ),
}

BLOCK = block_size(SPECS["siren"])


def by_hand(network: Network, point: np.ndarray, chart: int) -> list[float]:
    spec = network.spec
    mirrored = [spec.mirror >> axis & 1 for axis in range(3)]
    coordinates = [abs(float(p)) if m else float(p) for p, m in zip(point, mirrored, strict=True)]
    coordinates += [float(point[axis]) for axis in range(3) if spec.mirror >> 3 + axis & 1]
    if spec.conditioning == "scalar":
        coordinates.append((2 * chart + 1) / spec.charts - 1)
    values = coordinates
    if spec.encoding == "fourier":
        values = []
        for p in coordinates:
            for i in range(spec.levels):
                values += [math.sin(2**i * math.pi * p), math.cos(2**i * math.pi * p)]
    if spec.embedding:
        values = [*values, *network.tensors["embedding"][chart].tolist()]
    for weight, bias in network.layers[:-1]:
        before = weight.astype(float) @ np.array(values) + bias
        sine = spec.activation == "sine"
        values = [math.sin(spec.w0 * z) if sine else max(0.0, z) for z in before]
    weight, bias = network.layers[-1]
    last = weight.astype(float) @ np.array(values) + bias
    if spec.conditioning == "chart_affine":
        slopes = network.tensors["slopes"][chart].reshape(len(last), -1).astype(float)
        last = last + slopes @ np.array(coordinates) + network.tensors["offsets"][chart]
    outputs: dict[str, Callable[[float], float]] = {
        "identity": lambda z: z,
        "tanh": math.tanh,
        "sigmoid": lambda z: 1 / (1 + math.exp(-z)),
    }
    return [outputs[spec.output](z) for z in last]


@pytest.mark.parametrize("name", SPECS)
def test_agrees_with_the_specification(name: str) -> None:
    network = tiny.random_network(SPECS[name], seed=3, scale=0.2)
    rng = np.random.default_rng(0)
    points = rng.uniform(-1, 1, (50, 3)).astype(np.float32)
    charts = rng.integers(0, max(network.spec.charts, 1), 50)
    expected = [by_hand(network, p, c) for p, c in zip(points, charts.tolist(), strict=True)]
    np.testing.assert_allclose(evaluate(network, points, charts), expected, atol=2e-5)


@pytest.mark.parametrize("count", [0, 1, BLOCK - 1, BLOCK, BLOCK + 1, 3 * BLOCK + 5])
def test_any_number_of_points(count: int) -> None:
    network = tiny.random_network(SPECS["siren"], scale=0.1)
    points = np.random.default_rng(1).uniform(-1, 1, (count, 3)).astype(np.float32)
    values = evaluate(network, points)
    assert values.shape == (count, 3)
    assert values.dtype == np.float32
    for row in {0, count // 2, count - 1} & set(range(count)):
        np.testing.assert_allclose(values[row], by_hand(network, points[row], 0), atol=1e-4)


@pytest.mark.parametrize("outputs", [1, 2, 255, 256, 300])
def test_classes_are_the_largest_outputs(outputs: int) -> None:
    network = tiny.random_network(NetworkSpec((8,), outputs, w0=2.0), scale=0.5)
    points = np.random.default_rng(5).uniform(-1, 1, (700, 3)).astype(np.float32)
    values = evaluate(network, points)
    assert np.array_equal(classify(network, points), values.argmax(axis=1))
    few = (outputs + 1) // 2
    assert np.array_equal(classify(network, points, few), values[:, :few].argmax(axis=1))


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_of_outputs_that_are_alike_or_no_numbers_the_first_is_the_class(value: float) -> None:
    network = tiny.random_network(NetworkSpec((8,), 300, w0=2.0), scale=0.0)
    network.layers[-1][1][:] = value
    assert not classify(network, np.zeros((5, 3), np.float32)).any()


@pytest.mark.parametrize("activation", ["sine", "relu"])
@pytest.mark.parametrize("encoding", ["identity", "fourier"])
@pytest.mark.parametrize("output", ["identity", "tanh", "sigmoid"])
@pytest.mark.parametrize("mirror", [0, 0b001, 0b110, 0b110111])
def test_gradient_is_the_slope_of_the_values(
    activation: str, encoding: str, output: str, mirror: int
) -> None:
    spec = NetworkSpec(
        (12, 12, 12),
        1,
        encoding=encoding,
        levels=2 if encoding == "fourier" else 0,
        activation=activation,
        w0=2.0,
        output=output,
        mirror=mirror,
    )
    network = tiny.random_network(spec, seed=5)
    points = np.random.default_rng(2).uniform(-1, 1, (200, 3)).astype(np.float32)
    values, slopes = gradient(network, points)
    np.testing.assert_allclose(values, evaluate(network, points)[:, 0], atol=1e-6)
    step = 1e-3
    for axis in range(3):
        offset = np.float32(step) * np.eye(3, dtype=np.float32)[axis]
        rise = evaluate(network, points + offset) - evaluate(network, points - offset)
        error = np.abs(rise[:, 0] / (2 * step) - slopes[:, axis])
        # A ReLU's kink between the two samples spoils the difference quotient, not the slope.
        assert np.quantile(error, 0.9) < 5e-3


@pytest.mark.parametrize("mirror", range(1, 8))
def test_a_mirror_makes_values_symmetric_and_gradients_antisymmetric(mirror: int) -> None:
    network = tiny.random_network(NetworkSpec((8, 8), 1, w0=2.0, mirror=mirror))
    points = np.random.default_rng(3).uniform(-1, 1, (40, 3)).astype(np.float32)
    values, slopes = gradient(network, points)
    for axis in range(3):
        signs = np.where(np.arange(3) == axis, -1, 1).astype(np.float32)
        other, turned = gradient(network, points * signs)
        symmetric = bool(mirror >> axis & 1)
        assert np.array_equal(other, values) == symmetric
        assert np.array_equal(turned, slopes * signs) == symmetric


def test_on_the_plane_of_a_mirror_the_gradient_lies_in_it() -> None:
    network = tiny.random_network(NetworkSpec((8, 8), 1, w0=2.0, mirror=0b001))
    point = np.array([[0.0, 0.3, -0.2], [-0.0, 0.3, -0.2]], np.float32)
    aside = np.array([[1e-6, 0, 0], [-1e-6, 0, 0]], np.float32)
    beside = gradient(network, point + aside)[1]
    slopes = gradient(network, point)[1]
    assert (slopes[:, 0] == 0).all()
    assert slopes == pytest.approx(np.tile(beside.mean(axis=0), (2, 1)), abs=1e-5)


def test_threads_may_ask_at_once_and_blas_keeps_its_threads() -> None:
    network = tiny.random_network(SPECS["siren"])
    points = np.random.default_rng(4).uniform(-1, 1, (5 * BLOCK, 3)).astype(np.float32)
    expected = evaluate(network, points)
    before = [library["num_threads"] for library in threadpool_info()]
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda _: evaluate(network, points), range(16)))
    assert all(np.array_equal(answer, expected) for answer in answers)
    assert [library["num_threads"] for library in threadpool_info()] == before


def test_gradient_of_no_points() -> None:
    values, slopes = gradient(tiny.octahedron(), np.zeros((0, 3), np.float32))
    assert values.shape == (0,)
    assert slopes.shape == (0, 3)


@pytest.mark.parametrize(
    "charts", [None, np.zeros(4, np.int32), np.array([0, 1, 5]), np.array([0, -1, 2])]
)
def test_bad_charts_are_refused(charts: np.ndarray | None) -> None:
    network = tiny.random_network(SPECS["frames"])
    with pytest.raises(QueryError, match="charts: expected"):
        evaluate(network, np.zeros((3, 3), np.float32), charts)


@pytest.mark.filterwarnings("error")
def test_what_overflows_is_no_warning() -> None:
    spec = NetworkSpec((1, 1), 1, activation="relu")
    tensors = {name: np.full(shape, 3e38, np.float32) for name, shape in spec.shapes.items()}
    values = evaluate(Network(spec, tensors), np.ones((2, 3), np.float32), None)
    assert np.isinf(values).all()


def test_blocks_of_thousands_of_outputs_are_small() -> None:
    assert block_size(NetworkSpec((4,), 65_535)) * 65_535 <= 2**22
    assert block_size(NetworkSpec((30,), 300)) == block_size(NetworkSpec((30,), 1))
