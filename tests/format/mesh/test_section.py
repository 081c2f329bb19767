"""A section with parts: what comes back, what is refused."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MAX_PLACED_FACES, MeshPart, Placement
from nispcodec.format.constants import MESH_FACES_PER_BYTE
from nispcodec.format.mesh import decode, encode
from tests.format.mesh.parts import box, faces_of, grid, part, parts, vertices_of

# Of 25 milliseconds each.
EXAMPLES = 40
SCALARS = ("step", "origin", "uv_step", "uv_origin")


@given(parts())
@settings(max_examples=EXAMPLES)
def test_what_comes_back(made: MeshPart) -> None:
    (found,) = decode(encode((made,)))
    assert faces_of(found) == faces_of(made)
    assert vertices_of(found) == vertices_of(made)
    assert len(found.placements) == len(made.placements)
    assert all(getattr(found, name) == getattr(made, name) for name in SCALARS)


@given(parts())
@settings(max_examples=EXAMPLES)
def test_what_was_decoded_encodes_to_the_same_again(made: MeshPart) -> None:
    data = encode((made,))
    again = encode(decode(data))
    edges = np.sort(np.stack([made.faces, np.roll(made.faces, -1, axis=1)], axis=2).reshape(-1, 2))
    if np.unique(edges, axis=0, return_counts=True)[1].max() < 3:
        assert again == data
    (one,), (other,) = decode(data), decode(again)
    assert faces_of(one) == faces_of(other)
    assert vertices_of(one) == vertices_of(other)


@given(st.lists(parts(), min_size=1, max_size=3))
@settings(max_examples=EXAMPLES)
def test_several_parts(made: list[MeshPart]) -> None:
    found = decode(encode(tuple(made)))
    assert [faces_of(each) for each in found] == [faces_of(each) for each in made]


@given(parts(), st.data())
def test_missing_bytes_and_others_are_refused_or_read(made: MeshPart, data: st.DataObject) -> None:
    whole = encode((made,))
    place = data.draw(st.integers(0, len(whole) - 1))
    changed = bytearray(whole)
    changed[place] ^= data.draw(st.integers(1, 255))
    for broken in (whole[:place], bytes(changed)):
        with suppress(FormatError):
            decode(broken)


def test_bytes_after_the_end_are_refused() -> None:
    with pytest.raises(FormatError, match="field end"):
        decode(encode((grid(),)) + bytes(4) + b"\1")


def test_faces_are_bounded_by_the_bytes() -> None:
    flat = grid(40)
    data = encode((flat,))
    assert len(data) * MESH_FACES_PER_BYTE >= len(flat.faces)
    with pytest.raises(FormatError, match="faces"):
        decode(data[: len(flat.faces) // MESH_FACES_PER_BYTE - 1])


def test_no_parts() -> None:
    for data in (encode(()), b""):
        with pytest.raises(FormatError, match="field parts: expected at least one"):
            decode(data)


def test_placements_and_their_materials_are_bounded() -> None:
    copies = (Placement(materials=np.zeros(1, np.int32)),) * 4096
    data = encode((replace(box(), placements=copies),))
    assert len(decode(data)[0].placements) == 4096
    # Triangles apart are charts apart, each of which has a material at every place.
    corners = np.random.default_rng(0).integers(0, 1000, (3 * 64, 3))
    apart = part(corners, np.arange(3 * 64).reshape(-1, 3), placements=copies)
    with pytest.raises(FormatError, match="field placement_materials"):
        encode((apart,))


def test_faces_of_all_copies_are_bounded() -> None:
    flat = replace(grid(16), placements=(Placement(),) * 4096)
    assert flat.placed_faces == MAX_PLACED_FACES
    assert decode(encode((flat,)))[0].placed_faces == MAX_PLACED_FACES
    with pytest.raises(FormatError, match="field placed_faces"):
        encode((flat, box()))


def test_a_face_that_has_a_vertex_twice_is_refused() -> None:
    with pytest.raises(FormatError, match="field faces"):
        encode((part(np.zeros((2, 3)), np.array([[0, 1, 1]])),))


def test_a_flat_grid_with_a_map_takes_few_bytes() -> None:
    assert len(encode((grid(20),))) < 160
    assert len(encode((box(),))) < 60


def test_parts_that_are_alike_take_less_together() -> None:
    together = len(encode((grid(), box(), grid(), box())))
    assert together < 2 * len(encode((grid(),))) + 2 * len(encode((box(),)))
    assert np.array_equal(decode(encode((grid(), box())))[1].sheet, box().sheet)
