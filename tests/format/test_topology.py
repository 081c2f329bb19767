from __future__ import annotations

import dataclasses
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.core.network import NetworkSpec
from nispcodec.format import topology
from nispcodec.format.record import Record
from tests.format.documents import networks

SDF = NetworkSpec((32,), 1)


def decoded(fields: dict[int, Any], charts: int) -> dict[str, NetworkSpec]:
    return topology.decode(Record("META", "networks", fields), charts)


@given(st.integers(2, 9), st.data())
@settings(max_examples=30)
def test_any_topology_comes_back(charts: int, data: st.DataObject) -> None:
    specs = {
        "sdf": data.draw(networks(1)).spec,
        "chart": data.draw(networks(charts)).spec,
        "uv": data.draw(networks(2, charts)).spec,
    }
    assert decoded(topology.encode(specs), charts) == specs


def test_the_usual_network_is_its_widths_alone() -> None:
    assert topology.encode({"sdf": SDF}) == {1: {1: [32]}}


def test_outputs_are_those_of_the_networks_use() -> None:
    found = decoded({1: {1: [4]}, 2: {1: [4]}, 3: {1: [4]}}, 7)
    assert {name: spec.outputs for name, spec in found.items()} == {"sdf": 1, "chart": 7, "uv": 2}


@pytest.mark.parametrize("name", ["sdf", "chart"])
def test_only_the_uv_network_may_ask_for_the_chart(name: str) -> None:
    spec = dataclasses.replace(SDF, conditioning="scalar", charts=2)
    text = rf"networks\.{name}\.conditioning: expected none, found scalar"
    with pytest.raises(FormatError, match=text):
        topology.encode({name: spec})
    fields = {1: {1: [32]}} | {1 + ["sdf", "chart"].index(name): {1: [32], 4: 2}}
    with pytest.raises(FormatError, match=text):
        decoded(fields, 2)


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({2: {1: [4]}}, "networks.sdf: expected present, found absent"),
        ({1: {1: [4.0]}}, "networks.sdf.hidden: expected integers, found another type"),
        ({1: {1: [True]}}, "networks.sdf.hidden: expected integers, found another type"),
        ({1: {1: [2000]}}, "networks.sdf.hidden: expected 1 to 1024, found 2000"),
        ({1: {1: [4], 7: 30.0}}, "networks.sdf.w0: expected absent, being the default"),
        ({1: {1: [4]}, 9: {}}, "networks.keys: expected only known keys, found 9"),
    ],
)
def test_malformed_topologies_are_named(fields: dict[int, Any], text: str) -> None:
    with pytest.raises(FormatError, match=f"section META, field {text}"):
        decoded(fields, 2)
