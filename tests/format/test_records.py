from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.core.network import NetworkSpec
from nispcodec.format import records
from nispcodec.format.codings import registry
from nispcodec.format.codings.reader import Reader
from nispcodec.format.constants import MAX_SYMBOL
from nispcodec.format.tag import MOST_TOGETHER
from tests.format.documents import network, quantized

SPEC = NetworkSpec((5, 4, 3), 2)


def test_a_bias_is_a_matrix_of_one_row_and_symbols_times_the_step_are_the_weights() -> None:
    source = quantized(network(SPEC), 0.25)
    found = records.tensors("uv", source)
    assert [each.path for each in found] == [f"uv.{name}" for name in SPEC.shapes]
    for each, weights in zip(found, source.tensors.values(), strict=True):
        assert each.matrix.shape == each.initial.shape == np.atleast_2d(weights).shape
        assert each.matrix.dtype == np.int32
        np.testing.assert_array_equal(each.matrix * np.float32(0.25), np.atleast_2d(weights))


def test_only_neighbors_of_one_step_share_a_record() -> None:
    source = quantized(network(SPEC), 0.25)
    steps = {name: 0.25 for name in source.steps if name != "bias.1"}
    found = records.candidates("uv", dataclasses.replace(source, steps=steps))
    names = list(SPEC.shapes)
    apart = names.index("bias.1")
    for start, end, record in found:
        assert 1 <= end - start == len(record.tensors) <= MOST_TOGETHER
        assert end - start == 1 or not start <= apart < end
        assert end - start == 1 or not record.coding.codec
    pairs = {(start, end) for start, end, _ in found}
    assert (0, MOST_TOGETHER) not in pairs
    assert {(0, apart), (apart, apart + 1), (apart + 1, len(names))} <= pairs


def test_the_cheapest_records_cover_every_tensor_once_at_the_least_cost() -> None:
    source = quantized(network(NetworkSpec((3,), 1)), 0.25)
    every = records.candidates("sdf", source)
    chosen = records.cheapest(every, registry.REGISTRY)
    covered = [tensor.path for record in chosen for tensor in record.tensors]
    assert covered == [f"sdf.{name}" for name in source.tensors]

    def least(start: int) -> float:
        ways = [(end, record.size) for first, end, record in every if first == start]
        return min((size + least(end) for end, size in ways), default=0.0)

    assert sum(record.size for record in chosen) == pytest.approx(least(0))


@pytest.mark.parametrize("coding", [each for each in registry.REGISTRY if each.codec])
def test_a_record_is_read_as_it_was_written(coding: registry.Coding) -> None:
    source = quantized(network(SPEC), 0.25, density=0.5)
    chosen = records.cheapest(records.candidates("uv", source), [coding])
    reader = Reader("NETS", b"".join(record.encode() for record in chosen))
    parts = records.read(reader, "uv", SPEC)
    reader.finish()
    assert reader.path == ""
    for part, (name, weights) in zip(parts, source.tensors.items(), strict=True):
        assert (part.names, part.step, part.header) == ([name], 0.25, None)
        assert part.values is not None
        symbols = part.values + part.expected << part.row_shifts
        np.testing.assert_array_equal(symbols * np.float32(0.25), weights.ravel())


@pytest.mark.parametrize("symbol", [MAX_SYMBOL, -MAX_SYMBOL])
def test_symbols_have_a_limit(symbol: int) -> None:
    source = quantized(network(SPEC), 0.25)
    source.tensors["weight.0"][0, 0] = symbol / 4
    assert records.tensors("uv", source)[0].matrix[0, 0] == symbol
    source.tensors["weight.0"][0, 0] = np.sign(symbol) * 2**21
    with pytest.raises(FormatError, match=r"uv\.weight\.0: expected multiples of the step 0\.25"):
        records.tensors("uv", source)


@pytest.mark.parametrize("step", [0.0, -0.25, float("nan"), float("inf")])
def test_a_step_is_a_positive_number(step: float) -> None:
    source = dataclasses.replace(network(SPEC), steps={"bias.2": step})
    text = r"section NETS, field uv\.bias\.2\.step: expected a positive float32"
    with pytest.raises(FormatError, match=text):
        records.tensors("uv", source)
