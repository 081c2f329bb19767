"""The decoder in `format_spec.md` reads what we write, and refuses what we refuse."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format.mesh import decode, encode
from nispcodec.format.mesh.logistic import STRETCH
from nispcodec.format.mesh.priors import SURE, table
from tests.format import spec
from tests.format.mesh.parts import box, grid, parts

DECODER = spec.decoder()
READ = DECODER["read_mesh"]
ARRAYS = (
    *("positions", "faces", "uvs", "uv_faces", "face_charts"),
    *("chart_materials", "chart_has_uv", "creases", "sheet"),
)


def plain(made: MeshPart) -> dict[str, Any]:
    """A part as the specification's decoder gives it."""
    scalars = {name: getattr(made, name) for name in ("step", "origin", "uv_step", "uv_origin")}
    places = [vars(place) for place in made.placements]
    arrays = {name: getattr(made, name).tolist() for name in ARRAYS}
    return listed(arrays | scalars | {"placements": places})


def listed(value: Any) -> Any:
    """Lists instead of tuples and arrays."""
    if isinstance(value, dict):
        return {key: listed(each) for key, each in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    return [listed(each) for each in value] if isinstance(value, list | tuple) else value


@given(st.lists(parts(), min_size=1, max_size=2))
@settings(max_examples=30)
def test_it_reads_what_we_write(made: list[MeshPart]) -> None:
    data = encode(tuple(made))
    assert listed(READ(data)) == [plain(each) for each in decode(data)]


def test_its_tables() -> None:
    assert {slot: (share << 8, SURE) for slot, share in DECODER["MESH_PRIORS"].items()} == table()
    assert tuple(DECODER["MESH_STRETCH"]) == STRETCH


def test_known_shapes() -> None:
    data = encode((grid(), box(), grid(turned=True)))
    assert listed(READ(data)) == [plain(each) for each in decode(data)]


@given(parts(), st.data())
@settings(max_examples=30)
def test_it_refuses_what_we_refuse(made: MeshPart, data: st.DataObject) -> None:
    changed = bytearray(encode((made,)))
    place = data.draw(st.integers(0, len(changed) - 1))
    changed[place] ^= data.draw(st.integers(1, 255))
    try:
        found = decode(bytes(changed))
    except FormatError:
        with pytest.raises((AssertionError, IndexError, OverflowError)):
            READ(bytes(changed))
    else:
        assert listed(READ(bytes(changed))) == [plain(each) for each in found]
