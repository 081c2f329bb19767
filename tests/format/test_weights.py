from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from nispcodec.core.errors import FormatError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.format import weights
from nispcodec.format.codings import rans
from nispcodec.format.codings.frequency_model import FrequencyModel
from nispcodec.format.codings.registry import CODINGS
from tests.format.documents import network, networks, quantized

SPEC = NetworkSpec((6,), 1)


@given(networks(1), networks(2, 3))
@settings(max_examples=8)
def test_the_bytes_of_the_networks_are_all_there_are(sdf: Network, uv: Network) -> None:
    both = {"sdf": sdf, "uv": uv}
    data = weights.encode(both, None)
    found, lengths = weights.decode({name: each.spec for name, each in both.items()}, data)
    assert list(found) == list(lengths) == ["sdf", "uv"]
    assert sum(lengths.values()) == len(data)
    assert min(lengths.values()) > 0


def test_weights_are_single_precision_and_own_their_memory() -> None:
    data = bytearray(weights.encode({"sdf": quantized(network(SPEC))}, "dense"))
    found, _ = weights.decode({"sdf": SPEC}, memoryview(data))
    before = {name: tensor.copy() for name, tensor in found["sdf"].tensors.items()}
    data[:] = bytes(len(data))
    for name, tensor in found["sdf"].tensors.items():
        assert tensor.dtype == np.float32
        assert tensor.flags.c_contiguous
        np.testing.assert_array_equal(tensor, before[name])


def test_a_larger_network_gets_more_of_the_common_stream() -> None:
    pair = {
        "sdf": quantized(network(NetworkSpec((60,), 1))),
        "chart": quantized(network(NetworkSpec((6,), 2))),
    }
    _, lengths = weights.decode(
        {name: each.spec for name, each in pair.items()}, weights.encode(pair, "entropy")
    )
    assert lengths["sdf"] > 5 * lengths["chart"]


def test_an_unknown_coding_is_refused() -> None:
    with pytest.raises(
        FormatError, match=f"coding: expected one of {', '.join(CODINGS)}, found lz"
    ):
        weights.encode({"sdf": network(SPEC)}, "lz")


def test_too_many_weights_are_refused_before_any_is_read() -> None:
    large = NetworkSpec((1024, 700), 1)
    one = large.weight_count
    with pytest.raises(FormatError, match=f"weights: expected at most 1048576, found {2 * one}"):
        weights.decode({"sdf": large, "uv": large}, b"")
    tensors = {name: np.zeros(shape, np.float32) for name, shape in large.shapes.items()}
    both = dict.fromkeys(("sdf", "uv"), Network(large, tensors))
    with pytest.raises(FormatError, match=f"weights: expected at most 1048576, found {2 * one}"):
        weights.encode(both, None)


def test_a_stream_of_less_than_a_bit_is_accounted_for() -> None:
    """All weights in one record, all zero, under a model that expects as much."""
    spec = NetworkSpec((1,), 1)
    model = FrequencyModel(0, 0, 255)
    start, end = model.starts(1)[1:3].tolist()
    record = bytes([6 | 1 << 3 | 3 << 6, 100, 1]) + model.encode()
    stream = rans.encode([start] * spec.weight_count, [end - start] * spec.weight_count)
    _, lengths = weights.decode({"sdf": spec}, record + stream)
    assert lengths == {"sdf": len(record) + len(stream)}
