from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

from nispcodec.core.asset import Material
from nispcodec.core.document import ChartTable, Document, Frame
from nispcodec.core.errors import FormatError
from nispcodec.core.network import NetworkSpec
from nispcodec.format import canonical, metadata
from tests.format.documents import documents, full, network, tiny
from tests.tiny import field_of, varied


@given(documents())
@settings(max_examples=10)
def test_all_but_weights_and_images_comes_back(document: Document) -> None:
    found = metadata.decode(metadata.encode(document))
    assert found.frame == document.frame
    assert found.materials == document.materials
    assert found.half_thickness == field_of(document).half_thickness
    assert found.specs == {name: each.spec for name, each in document.networks.items()}
    assert [name for name, _, _ in found.textures] == [each.name for each in document.textures]
    table = found.charts
    assert table
    np.testing.assert_array_equal(table.materials, field_of(document).charts.materials)
    np.testing.assert_array_equal(table.has_uv, field_of(document).charts.has_uv)
    assert (table.materials.dtype, table.has_uv.dtype) == (np.dtype("i4"), np.dtype(bool))
    assert (table.uv_offset, table.uv_scale) == (
        field_of(document).charts.uv_offset,
        field_of(document).charts.uv_scale,
    )


def test_weights_and_images_change_nothing() -> None:
    textures = tuple(dataclasses.replace(each, data=each.data[::-1]) for each in full().textures)
    other = varied(
        dataclasses.replace(full(), textures=textures), sdf=network(field_of(full()).sdf.spec, 9)
    )
    assert metadata.encode(other) == metadata.encode(full())


@pytest.mark.parametrize(("kinds", "width"), [(256, 1), (257, 2)])
def test_charts_name_their_materials_in_one_byte_or_two(kinds: int, width: int) -> None:
    charts = ChartTable(np.array([0, kinds - 1, 0], np.int32), np.zeros(3, np.bool_))
    document = varied(
        tiny(),
        charts=charts,
        materials=(Material(),) * kinds,
        chart=network(NetworkSpec((2,), 3)),
    )
    data = metadata.encode(document)
    assert len(canonical.decode("META", data)[4]) == 3 * width
    table = metadata.decode(data).charts
    assert table
    assert table.materials.tolist() == [0, kinds - 1, 0]


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({4: b"\x00\x01"}, "chart_materials: expected 3 bytes, found 2"),
        ({5: b"\xc0\x00"}, "chart_has_uv: expected 1 bytes, found 2"),
        ({5: b"\xd0"}, "chart_has_uv: expected zeros after the last chart, found a set bit"),
        ({5: b"\xe0"}, "chart_has_uv: expected absent, being all set, found present"),
        ({4: bytes(3)}, "chart_materials: expected absent, being all 0, found present"),
        ({3: 70_000}, "charts: expected 1 to 65535, found 70000"),
    ],
)
def test_tables_that_do_not_fit_the_charts_are_refused(changes: dict[int, Any], text: str) -> None:
    fields = canonical.decode("META", metadata.encode(full())) | changes
    with pytest.raises(FormatError, match=f"section META, field document.{text}"):
        metadata.decode(canonical.encode("META", fields))


def test_a_frame_without_a_number_is_refused() -> None:
    document = dataclasses.replace(tiny(), frame=Frame((0.0, float("nan"), 0.0), 1.0))
    with pytest.raises(FormatError, match="expected a finite number, found nan"):
        metadata.encode(document)
