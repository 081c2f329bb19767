"""Each coding brings back any matrix: any mask, any finite weights, any symbols."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.format.codings import bits, coo, csc, csr, dense, dia, entropy, frequency_model, rans
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.codings.registry import REGISTRY, Codec
from nispcodec.format.constants import MAX_CELLS, MAX_SYMBOL

OWN = {coding.name: coding.codec for coding in REGISTRY if coding.codec}
FLOATS = st.floats(width=32, allow_nan=False, allow_infinity=False).map(lambda x: x + 0.0)
HALVES = st.floats(width=16, allow_nan=False, allow_infinity=False).map(lambda x: x + 0.0)
SYMBOLS = st.integers(-MAX_SYMBOL, MAX_SYMBOL)


def matrices() -> st.SearchStrategy[np.ndarray[Any, Any]]:
    """Matrices of floats or symbols, mostly zero to not at all."""
    shape = hnp.array_shapes(min_dims=2, max_dims=2, max_side=9)
    zero = st.just(0)
    floats = hnp.arrays(np.float32, shape, elements=st.one_of(zero, FLOATS, HALVES))
    symbols = hnp.arrays(np.int32, shape, elements=st.one_of(zero, st.integers(-9, 9), SYMBOLS))
    return st.one_of(floats, symbols)


def through(coding: Codec, matrix: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """The matrix encoded and decoded, with nothing left to read."""
    reader = Reader("NETS", coding.encode(matrix))
    decoded = coding.decode(reader, matrix.shape, matrix.dtype.kind == "i")
    reader.finish()
    return np.asarray(decoded)


def streamed(values: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """Runs of the coding entropy through one stream."""
    runs = [entropy.SymbolRun(each) for each in values]
    reader = Reader("NETS", b"".join(run.header() for run in runs) + entropy.encode(runs))
    headers = [entropy.read_header(reader, each.size, each.dtype.kind == "i") for each in values]
    decoded = [each for each, _ in entropy.decode(reader, headers)]
    reader.finish()
    return decoded


@pytest.mark.parametrize("name", OWN)
@given(matrix=matrices())
def test_any_matrix(name: str, matrix: np.ndarray[Any, Any]) -> None:
    np.testing.assert_array_equal(through(OWN[name], matrix), matrix)


@given(st.lists(matrices(), min_size=1, max_size=4))
def test_any_stream(together: list[np.ndarray[Any, Any]]) -> None:
    runs = [matrix.ravel() for matrix in together]
    for decoded, run in zip(streamed(runs), runs, strict=True):
        np.testing.assert_array_equal(decoded, run)


@pytest.mark.parametrize("extra", [-1, 0, 1, 5000])
def test_long_streams_take_turns(extra: int) -> None:
    generator = np.random.default_rng(0)
    drawn = generator.normal(0, 20, rans.LONG + extra).round().astype(np.int32)
    runs = [np.zeros(7, np.int32), drawn[:999], drawn[999:] * 40]
    for decoded, run in zip(streamed(runs), runs, strict=True):
        np.testing.assert_array_equal(decoded, run)


@pytest.mark.parametrize("density", [0.0, 0.01, 1.0])
@pytest.mark.parametrize("shape", [(300, 2), (2, 300), (66_000, 2), (1, 1)])
def test_indices_of_every_width(shape: tuple[int, int], density: float) -> None:
    generator = np.random.default_rng(0)
    mask = generator.random(shape) < density
    matrix = (mask * generator.integers(1, 9, shape)).astype(np.int32)
    for coding in OWN.values():
        np.testing.assert_array_equal(through(coding, matrix), matrix)


def test_the_bytes_of_a_small_matrix() -> None:
    matrix = np.array([[0, 3, 0, 0], [0, 0, 0, 0], [-1, 0, 0, 300]], np.int32)
    values = b"\x04" + np.array([3, -1, 300], "<i2").tobytes()
    assert coo.encode(matrix) == b"\x03" + b"\0\2\0" + b"\1\0\2" + values
    assert csr.encode(matrix) == b"\1\0\2" + b"\1\0\2" + values
    down = b"\x04" + np.array([-1, 3, 300], "<i2").tobytes()
    assert csc.encode(matrix) == b"\1\1\0\1" + b"\2\0\2" + down
    diagonals = np.array([-1, 3, 0, 300], "<i2").tobytes()
    assert dia.encode(matrix) == b"\2" + b"\0\2" + b"\x04" + diagonals


def test_numbers_take_the_smallest_kind() -> None:
    kinds = {127: 3, 128: 4, -32768: 4, 32768: 5}
    for symbol, kind in kinds.items():
        assert dense.encode(np.array([[symbol]], np.int32))[0] == kind
    assert dense.encode(np.array([[0.5]], np.float32))[0] == 2
    assert dense.encode(np.array([[0.1]], np.float32))[0] == 1


@given(st.integers(1, 2**31))
def test_cells(limit: int) -> None:
    cells, left_open = frequency_model.cells(limit)
    assert cells <= MAX_CELLS
    assert (cells - 1) << left_open < limit <= cells << left_open
    assert left_open == 0 or limit > MAX_CELLS << left_open - 1


@given(hnp.arrays(np.int64, st.integers(2, 257), elements=st.integers(0, 10**6)).filter(np.any))
def test_the_curve_that_fits(counts: np.ndarray[Any, Any]) -> None:
    best, claimed = frequency_model.fit(counts)
    bits_each = rans.SCALE_BITS - np.log2(np.diff(best.starts(len(counts) - 1)))
    assert bits_each[len(counts) - 1 :] @ counts + 8 * (best.zeros > 0) == pytest.approx(claimed)
    reader = Reader("NETS", best.encode())
    assert frequency_model.decode(reader) == best
    reader.finish()


@given(st.data())
def test_rans(data: st.DataObject) -> None:
    tokens, runs = [], []
    for _ in range(data.draw(st.integers(1, 3))):
        drawn = data.draw(st.lists(st.integers(0, 8), max_size=60))
        tokens.append(np.array(drawn, np.int64))
        runs.append(
            (
                len(drawn),
                frequency_model.FrequencyModel(data.draw(st.integers(0, 31)), 1, 0).starts(4),
            )
        )
    pairs = list(zip(tokens, [starts for _, starts in runs], strict=True))
    starts = np.concatenate([starts[run] for run, starts in pairs])
    frequencies = np.concatenate([np.diff(starts)[run] for run, starts in pairs])
    reader = Reader("NETS", rans.encode(starts.tolist(), frequencies.tolist()))
    np.testing.assert_array_equal(rans.decode(reader, runs), np.concatenate(tokens))
    reader.finish()


@pytest.mark.parametrize("spread", [0.3, 5, 20])
@pytest.mark.parametrize("shape", ["normal", "laplace", "logistic"])
def test_quantized_weights_cost_little_more_than_their_entropy(spread: float, shape: str) -> None:
    drawn = getattr(np.random.default_rng(0), shape)(0, spread, 3000)
    symbols = np.rint(drawn).astype(np.int32)
    _, counts = np.unique(symbols, return_counts=True)
    ideal = -(counts * np.log2(counts / counts.sum())).sum() / 8
    run = entropy.SymbolRun(symbols)
    stream = entropy.encode([run])
    assert len(stream) < run.streamed() + 4
    assert len(run.header()) + len(stream) < 1.03 * ideal + 8


def test_pruned_symbols_cost_little_more_than_their_entropy() -> None:
    generator = np.random.default_rng(0)
    symbols = np.rint(generator.normal(0, 30, 3000) * (generator.random(3000) < 0.15))
    _, counts = np.unique(symbols, return_counts=True)
    ideal = -(counts * np.log2(counts / counts.sum())).sum() / 8
    assert len(entropy.encode([entropy.SymbolRun(symbols.astype(np.int32))])) < 1.05 * ideal + 8


@given(st.lists(st.tuples(st.integers(0, 2**32 - 1), st.integers(0, 32)), max_size=40))
def test_bits(pairs: list[tuple[int, int]]) -> None:
    widths = np.array([width for _, width in pairs], np.uint8)
    values = np.array([value % 2**width for value, width in pairs], np.uint32)
    reader = Reader("NETS", bits.encode(values, widths))
    np.testing.assert_array_equal(bits.decode(reader, "bits", widths), values)
    reader.finish()


@given(st.integers(0, 2**35 - 1))
def test_varint(value: int) -> None:
    reader = Reader("NETS", varint(value))
    assert reader.varint("value", 2**35) == value
    reader.finish()
