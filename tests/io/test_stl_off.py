from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read.off import read_off
from nispcodec.io.read.stl import read_stl
from tests.io.files import outcome

NOWHERE = Folder(Path("/nonexistent"))
CORNERS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
TEXT_STL = (
    b"solid my part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    b"   vertex 0 1 0\n  endloop\n endfacet\nendsolid\n"
)
OFF = b"OFF\n# a square\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"


def binary_stl(corners: list[list[float]], header: bytes = b"solid but binary") -> bytes:
    facet = struct.pack("<12fH", 0, 0, 1, *[value for corner in corners for value in corner], 0)
    return header.ljust(80, b"\0") + struct.pack("<I", 1) + facet


def stl(data: bytes) -> TexturedMesh:
    return read_stl(data, "a.stl", NOWHERE)


def off(data: bytes) -> TexturedMesh:
    return read_off(data, "a.off", NOWHERE)


@pytest.mark.parametrize("data", [TEXT_STL, binary_stl(CORNERS), TEXT_STL.upper()])
def test_stl(data: bytes) -> None:
    mesh = stl(data)
    assert mesh.corners.tolist() == [CORNERS]
    assert not mesh.has_uv.any()


@pytest.mark.parametrize(
    "data",
    [
        OFF,
        OFF.replace(b"OFF\n", b"OFF "),
        OFF.replace(b"OFF\n", b"OFF").replace(b"# a square\n", b""),
        OFF.replace(b"OFF", b"COFF").replace(b" 0\n", b" 0 255 0 0 255\n"),
        OFF.replace(b"0 1 2 3", b"0 1 2 3 255 0 0"),
        OFF.replace(b"\n", b"\r\n"),
        OFF.replace(b"OFF", b"off"),
    ],
)
def test_off(data: bytes) -> None:
    mesh = off(data)
    assert len(mesh.positions) == 4
    assert len(mesh.faces) == 2


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "a.stl: expected text"),
        (binary_stl(CORNERS, b"")[:-1], "a.stl: expected 1 facets of 50 bytes, found 0"),
        (
            TEXT_STL.replace(b"  endloop\n", b"  vertex 0 0 1\n" * 3 + b"  endloop\n"),
            "a.stl:10: expected three vertices in a loop, found 6",
        ),
        (binary_stl([*CORNERS[:2], [0, float("nan"), 0]]), "a.stl: facet 0: expected finite"),
        (TEXT_STL.replace(b"vertex 1", b"vertex inf"), "a.stl:5: expected 3"),
        (TEXT_STL.replace(b"vertex 1 0 0", b"vertex 1 0"), "a.stl:5: expected 3"),
        (TEXT_STL.replace(b"vertex 1 0 0\n", b""), "a.stl:6: expected three vertices"),
        (TEXT_STL.split(b"   vertex 0 1")[0], "expected an endloop after three vertices"),
    ],
)
def test_stl_errors_name_the_place(data: bytes, expected: str) -> None:
    with pytest.raises(MeshError) as caught:
        stl(data)
    assert expected in str(caught.value)


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"", "a.off:1: expected the keyword OFF"),
        (b"PLY\n", "a.off:1: expected the keyword OFF"),
        (b"OFF BINARY\n", "expected the keyword OFF and text"),
        (b"OFF\nmany 2 3\n", "a.off:2: expected counts"),
        (b"OFF\n", "expected counts"),
        (OFF.replace(b"4 1 0", b"999999999 1 0"), "a.off: expected 999999999 vertices, found 5"),
        (OFF.replace(b"4 1 0", b"4 2 0"), "expected 2 faces, found 1 before the end"),
        (OFF.replace(b"1 1 0\n", b"1 nan 0\n"), "a.off:6: expected 3 or more finite numbers"),
        (OFF.replace(b"2 3\n", b"2 4\n"), "a.off:8: expected a count and"),
        (OFF.replace(b"2 3\n", b"2 -1\n"), "a.off:8: "),
        (OFF.replace(b"2 3\n", b"2\n"), "a.off:8: "),
        (OFF.replace(b"2 3\n", b"2 x\n"), "a.off:8: "),
        (OFF.replace(b"4 0 1", b"-4 0 1"), "a.off:8: "),
    ],
)
def test_off_errors_name_the_line(data: bytes, expected: str) -> None:
    with pytest.raises(MeshError) as caught:
        off(data)
    assert expected in str(caught.value)


@pytest.mark.parametrize(
    ("data", "warning"),
    [
        (binary_stl(CORNERS) + b"\0\0", "left out 2 bytes after the facets"),
        (binary_stl(CORNERS).replace(b"\1\0\0\0", bytes(4), 1), "the header says 0 facets, 1 are"),
        (
            binary_stl(CORNERS).replace(b"\1\0\0\0", b"\xff" * 4, 1),
            "the header says 4294967295 facets, 1 are",
        ),
        (
            binary_stl(CORNERS, b"solid".ljust(80)).replace(b"\1\0\0\0", b"\xff" * 4, 1),
            "the header says 4294967295 facets, 1 are",
        ),
        (binary_stl(CORNERS)[:-1] + b"\x80", "left out facet colors"),
        (binary_stl(CORNERS, b"COLOR=\1\2\3\4"), "left out facet colors"),
    ],
)
def test_binary_stl_as_it_is_written(data: bytes, warning: str) -> None:
    mesh = stl(data)
    assert mesh.corners.tolist() == [CORNERS]
    assert len(mesh.warnings) == 1
    assert warning in mesh.warnings[0]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
def test_text_stl_with_a_byte_order_mark(encoding: str) -> None:
    assert stl(TEXT_STL.decode().encode(encoding)).corners.tolist() == [CORNERS]


def test_off_texture_coordinates() -> None:
    rows = b"0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 nan 1\n"
    mesh = off(b"STOFF\n4 2 0\n" + rows + b"3 0 1 2\n3 0 2 3\n")
    assert mesh.corner_uvs[0].tolist() == [[0, 0], [1, 0], [1, 1]]
    assert mesh.has_uv.tolist() == [True, False]
    assert len(mesh.warnings) == 1
    mesh = off(b"STCNOFF\n3 1 0\n" + b"0 0 0 0 0 1 9 9 9 9 .5 .25\n" * 3 + b"3 0 1 2\n")
    assert mesh.corner_uvs[0].tolist() == [[0.5, 0.25]] * 3


@pytest.mark.parametrize(
    ("data", "what"),
    [
        (OFF.replace(b"OFF", b"COFF").replace(b" 0\n", b" 0 255 0 0 255\n"), "vertex colors"),
        (OFF.replace(b"1 0 0\n", b"1 0 0 255 0 0\n"), "vertex colors"),
        (OFF.replace(b"0 1 2 3", b"0 1 2 3 255 0 0"), "face colors"),
        (
            OFF.replace(b"4 1 0", b"4 3 0").replace(b"4 0 1 2", b"2 0 1\n0\n4 0 1 2"),
            "faces of fewer than three corners",
        ),
        (OFF + b"3 0 1 2\n3 1 2 3\n", "lines after the last face"),
    ],
)
def test_what_off_loses_is_said(data: bytes, what: str) -> None:
    mesh = off(data)
    assert len(mesh.faces) == 2
    assert mesh.warnings == (f"a.off: left out {what}",)


def test_the_keyword_of_off_may_be_missing() -> None:
    assert off(OFF.replace(b"OFF\n", b"")).corners.tolist() == off(OFF).corners.tolist()


def test_an_unusable_position_that_no_face_has_costs_itself_alone() -> None:
    mesh = off(b"OFF\n4 1 0\n0 0 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 2 3\n")
    assert mesh.corners.tolist() == [CORNERS]
    assert mesh.warnings == (
        "a.off: left out 1 vertex without finite coordinates, which no face has",
    )


def test_normals_of_off_are_creases() -> None:
    faces = b"3 0 1 2\n3 0 2 3\n"
    rows = [b"0 0 0", b"1 0 0", b"1 1 0", b"0 1 1"]

    def creases(normals: list[bytes]) -> object:
        lines = [b"%b %b\n" % each for each in zip(rows, normals, strict=True)]
        mesh = off(b"NOFF\n4 2 0\n" + b"".join(lines) + faces)
        assert mesh.warnings == ()
        return None if mesh.creases is None else mesh.creases.any()

    assert creases([b"0 0 1"] * 4) is np.False_
    assert creases([b"nan 0 0"] * 4) is np.True_
    assert creases([b""] * 4) is np.True_


@given(st.binary(max_size=60), st.integers(0, 150))
def test_any_bytes_give_a_mesh_or_a_mesh_error(noise: bytes, at: int) -> None:
    for read, whole in ((stl, TEXT_STL), (stl, binary_stl(CORNERS)), (off, OFF)):
        for data in (noise, whole[:at] + noise + whole[at + len(noise) :]):
            assert isinstance(outcome(read, data), TexturedMesh | MeshError)
