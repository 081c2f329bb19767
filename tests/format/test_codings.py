"""Each coding brings back any matrix: any mask, any finite weights, any symbols."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from nispcodec.format.codings import bits, coo, csc, csr, dense, dia, entropy, rans, tables, tokens
from nispcodec.format.codings.reader import Reader, varint
from nispcodec.format.constants import LEVELS, MAX_SYMBOL, MAX_TOKENS
from nispcodec.format.container import write_container

OWN = {"dense": dense, "coo": coo, "csc": csc, "csr": csr, "dia": dia}
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


def through(coding: ModuleType, matrix: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """The matrix encoded and decoded, with nothing left to read."""
    reader = Reader("NETS", coding.encode(matrix))
    decoded = coding.decode(reader, matrix.shape, matrix.dtype.kind == "i")
    reader.finish()
    return np.asarray(decoded)


def pooled(matrices_: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """The matrices through one pool of the coding entropy."""
    pool = entropy.Pool([matrix.ravel() for matrix in matrices_])
    reader = Reader("NETS", b"".join(pool.heads()) + pool.encode())
    heads = [entropy.read_head(reader, each.size, each.dtype.kind == "i") for each in matrices_]
    decoded = entropy.decode(reader, heads)
    reader.finish()
    return [flat.reshape(each.shape) for flat, each in zip(decoded, matrices_, strict=True)]


@pytest.mark.parametrize("name", OWN)
@given(matrix=matrices())
def test_any_matrix(name: str, matrix: np.ndarray[Any, Any]) -> None:
    np.testing.assert_array_equal(through(OWN[name], matrix), matrix)


@given(st.lists(matrices(), min_size=1, max_size=4))
@settings(deadline=None)
def test_any_pool(together: list[np.ndarray[Any, Any]]) -> None:
    for decoded, matrix in zip(pooled(together), together, strict=True):
        np.testing.assert_array_equal(decoded, matrix)


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


@given(st.integers(0, 2**31 - 1))
def test_tokens(magnitude: int) -> None:
    token = tokens.from_magnitudes(np.array([magnitude], np.uint32))
    start, width = int(tokens.smallest(token)[0]), int(tokens.extra_bits(token)[0])
    assert start <= magnitude < start + 2**width
    assert token[0] < MAX_TOKENS


@given(st.lists(st.integers(0, 15), min_size=1, max_size=MAX_TOKENS).filter(any))
def test_frequencies(levels: list[int]) -> None:
    table = tables.frequencies(levels)
    assert sum(table) == rans.SCALE
    assert [frequency > 0 for frequency in table] == [level > 0 for level in levels]


@given(hnp.arrays(np.int64, MAX_TOKENS, elements=st.integers(0, 10**6)).filter(np.any))
def test_levels_hold_every_token_that_occurs(counts: np.ndarray[Any, Any]) -> None:
    levels = tables.levels(counts)
    assert [level > 0 for level in levels] == (counts[: len(levels)] > 0).tolist()
    assert not counts[len(levels) :].any()
    assert max(levels) == len(LEVELS) - 1


@given(st.data())
@settings(deadline=None)
def test_rans(data: st.DataObject) -> None:
    runs = []
    for _ in range(data.draw(st.integers(1, 3))):
        levels = data.draw(st.lists(st.integers(0, 15), min_size=1, max_size=9).filter(any))
        known = [token for token, level in enumerate(levels) if level]
        drawn = data.draw(st.lists(st.sampled_from(known), max_size=60))
        runs.append((bytes(drawn), tables.frequencies(levels)))
    reader = Reader("NETS", rans.encode(runs))
    decoded = rans.decode(reader, [(len(run), table) for run, table in runs])
    reader.finish()
    assert decoded == b"".join(run for run, _ in runs)


def test_rans_is_as_short_as_the_entropy() -> None:
    table = tables.frequencies([15, 8, 3])
    share = np.array(table) / rans.SCALE
    drawn = np.random.default_rng(0).choice(3, 20_000, p=share).astype(np.uint8)
    ideal = -np.log2(share[drawn]).sum() / 8
    assert ideal < len(rans.encode([(drawn.tobytes(), table)])) < ideal + 16


def test_quantised_weights_cost_little_more_than_their_entropy() -> None:
    """Whole file against the order-0 entropy of normal symbols, tables and all."""
    symbols = np.rint(np.random.default_rng(0).normal(0, 20, 8000)).astype(np.int32)
    _, counts = np.unique(symbols, return_counts=True)
    ideal = -(counts * np.log2(counts / counts.sum())).sum() / 8
    pool = entropy.Pool([symbols])
    assert len(pool.encode()) < 1.02 * ideal
    assert len(write_container([("NETS", True, pool.encode())])) < 1.03 * ideal


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
