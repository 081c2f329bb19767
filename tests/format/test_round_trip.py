"""Documents come back as they were, and a file has one form."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from nispcodec.core.asset import Material, Texture, TextureMap
from nispcodec.core.document import ChartTable, Document, Frame, StoredSection
from nispcodec.core.errors import FormatError
from nispcodec.core.network import NetworkSpec
from nispcodec.format import inspect, metadata, own_bytes, pack, unpack
from nispcodec.format.codings.registry import CODINGS
from tests.format.documents import assert_same, documents, full, network, quantized, tiny
from tests.format.test_measures import ENCODERS
from tests.tiny import varied


@given(documents())
@settings(max_examples=40)
def test_any_document(document: Document) -> None:
    data = pack(document)
    assert_same(unpack(data), document)
    assert pack(unpack(data)) == data


@pytest.mark.parametrize("coding", CODINGS)
def test_every_coding_keeps_every_document(coding: str) -> None:
    for document in (tiny(), full()):
        assert_same(unpack(pack(document, coding)), document)


@given(documents())
@settings(max_examples=10)
def test_every_coding_keeps_any_document(document: Document) -> None:
    for coding in CODINGS:
        assert_same(unpack(pack(document, coding)), document)


def test_the_default_is_as_small_as_any_coding() -> None:
    spec = NetworkSpec((32, 32, 32), 1)
    for sdf in (network(spec), quantized(network(spec)), quantized(network(spec), density=0.1)):
        document = varied(tiny(), sdf=sdf)
        smallest = min(len(pack(document, coding)) for coding in CODINGS)
        assert len(pack(document)) <= smallest


def test_inspect_accounts_for_every_byte() -> None:
    data = pack(full())
    sections = inspect(data)
    assert [section.code for section in sections] == ["META", "NETS", "TXTR", "ZZZZ"]
    assert sections[0].offset == 16 + 21 * len(sections)
    assert sections[0].offset + sum(section.stored_length for section in sections) == len(data)
    by_code = {section.code: section for section in sections}
    assert list(by_code["NETS"].parts) == ["sdf", "chart", "uv"]
    assert sum(by_code["NETS"].parts.values()) == by_code["NETS"].decoded_length
    assert by_code["TXTR"].parts == {"wood.png": 16, "wood normal.jpg": 10}


def test_own_bytes_are_those_without_images() -> None:
    plain = full()
    first, *others = plain.textures
    longer = varied(plain, textures=(dataclasses.replace(first, data=bytes(16)), *others))
    assert own_bytes(pack(longer)) == own_bytes(pack(plain)) < len(pack(plain))


def test_overhead_of_a_one_material_asset() -> None:
    """As an encoder writes it, with what it measured: two maps under names of usual lengths."""
    charts = ChartTable(np.zeros(13, np.int32), np.ones(13, np.bool_), (-0.25, 0.125), (1.25, 0.75))
    spec = NetworkSpec((32,) * 4, 2, conditioning="chart_affine", charts=13, embedding=4)
    document = varied(
        full(),
        frame=Frame((0.0, 0.25, 0.5), 1.5),
        charts=charts,
        materials=(
            Material("tea_set_01", maps={"base_color": TextureMap(0), "normal": TextureMap(1)}),
        ),
        textures=(
            Texture("tea_set_01_diff_1k.jpg", bytes(80_000), "image/jpeg"),
            Texture("tea_set_01_nor_gl_1k.jpg", bytes(90_000), "image/jpeg"),
        ),
        chart=network(NetworkSpec((32,) * 3, 13)),
        uv=network(spec),
        half_thickness=0.0,
        info=ENCODERS,
        extra={},
    )
    sections = inspect(pack(document))
    content = sum(section.stored_length for section in sections if section.code in ("NETS", "TXTR"))
    assert len(pack(document)) - content <= 256


def test_negative_zero_becomes_zero() -> None:
    sdf = network(NetworkSpec((2,), 1))
    sdf.tensors["weight.0"][0, 0] = -0.0
    back = unpack(pack(varied(tiny(), sdf=sdf))).networks["sdf"]
    assert not np.signbit(back.tensors["weight.0"][0, 0])


def test_weights_that_are_no_multiples_of_their_step() -> None:
    sdf = dataclasses.replace(network(NetworkSpec((2,), 1)), steps={"weight.0": 0.3})
    with pytest.raises(FormatError, match=r"sdf\.weight\.0: expected multiples of the step 0\.3"):
        pack(varied(tiny(), sdf=sdf))


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"materials": (Material("a\nb"),)}, "materials.a\nb.name"),
        ({"materials": (Material(alpha_mode="glow"),)}, "materials.material.alpha_mode"),
        ({"materials": (Material(base_color=(np.nan, 0, 0, 0)),)}, "number"),
        ({"info": {"a": [1]}}, "document.info.a"),
        ({"info": {"a": 2**64}}, "value"),
        ({"info": {"a": "\ud800"}}, "value"),
        ({"info": {"a": "x" * 2000}}, "text_length"),
        ({"extra": {"META": b""}}, "extra"),
        ({"extra": {"abcd": StoredSection(b"")}}, "section_code"),
        ({"extra": {"\ud800": StoredSection(b"")}}, "section_code"),
        ({"extra": {"LONGER": StoredSection(b"")}}, "section_code"),
        ({"extra": {f"X{i:03}": StoredSection(b"") for i in range(64)}}, "section_count"),
    ],
)
def test_documents_that_cannot_be_written(change: dict[str, Any], field: str) -> None:
    with pytest.raises(FormatError) as caught:
        pack(dataclasses.replace(tiny(), **change))
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("name", "stored"),
    [
        ("oak.png", b"\xa3oak"),
        ("oak.jpg", b"\xa7oak.jpg"),
        ("old.oak.png", b"\xabold.oak.png"),
        (".png", b"\xa4.png"),
    ],
)
def test_texture_names_go_without_their_usual_ending(name: str, stored: bytes) -> None:
    texture = dataclasses.replace(full().textures[0], name=name)
    data = metadata.encode(dataclasses.replace(full(), textures=(texture, texture)))
    assert data.count(b"\x01" + stored) == 2
    document = dataclasses.replace(full(), textures=(texture, full().textures[1]))
    assert unpack(pack(document)).textures == document.textures


def test_a_texture_name_without_ending() -> None:
    texture = dataclasses.replace(full().textures[0], name="wood")
    with pytest.raises(FormatError, match=r"a file name with an ending"):
        pack(dataclasses.replace(full(), textures=(texture, texture)))


@pytest.mark.parametrize("name", ["", ".", "..", "a/b.png", "..\\b.png", "c:b.png", "a\0.png"])
def test_texture_names_that_lead_elsewhere(name: str) -> None:
    texture = dataclasses.replace(full().textures[0], name=name)
    with pytest.raises(FormatError, match=r"a bare file name|control characters"):
        pack(dataclasses.replace(full(), textures=(texture, texture)))
