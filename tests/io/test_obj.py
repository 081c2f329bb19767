from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from nispcodec.core.asset import TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.folder import Folder
from nispcodec.io.read.obj import read_obj
from nispcodec.io.read.wavefront import SHORTEST_RUN
from tests.io.files import TRIANGLE, load_obj, outcome

NOWHERE = Folder(Path("/nonexistent"))


def read(text: str | bytes) -> TexturedMesh:
    return read_obj(text.encode() if isinstance(text, str) else text, "a.obj", NOWHERE)


def corners(mesh: TexturedMesh) -> object:
    return mesh.corners.tolist()


def test_positions_and_uvs_are_exactly_those_of_the_file() -> None:
    mesh = read("v 0.1 1e-7 -3\nv 1 0 0\nv 0 1 0\nvt 0.3 -1.7\nvt 5 2\nvt 0 0\nf 1/1 2/2 3/3\n")
    assert mesh.positions[0].tolist() == [0.1, 1e-7, -3.0]
    assert mesh.corner_uvs[0].tolist() == [[0.3, -1.7], [5.0, 2.0], [0.0, 0.0]]


def test_each_corner_has_a_uv_index_of_its_own() -> None:
    mesh = read(
        TRIANGLE + "v 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt .5 .5\nf 1/1 2/2 3/3\nf 2/4 4/2 3/1\n"
    )
    assert mesh.uv_faces.tolist() == [[0, 1, 2], [3, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2], [1, 3, 2]]


def test_negative_indices_count_back_from_the_face() -> None:
    mesh = read(TRIANGLE + "f -3 -2 -1\nv 0 0 9\nf -4 -3 -1\n")
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 1, 3]]


def test_faces_may_come_before_their_vertices() -> None:
    assert corners(read("f 1 2 3\n" + TRIANGLE)) == corners(read(TRIANGLE + "f 1 2 3\n"))


def test_objects_groups_and_materials_switch() -> None:
    mesh = read(
        TRIANGLE + "o one\ng a b\nusemtl red\nf 1 2 3\no two\nusemtl blue sky\nf 2 3 1\n"
        "usemtl red\nf 3 1 2\n"
    )
    assert mesh.face_materials.tolist() == [0, 1, 0]
    assert [material.name for material in mesh.materials] == ["red", "blue sky"]


@pytest.mark.parametrize(
    "text",
    [
        "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n",
        TRIANGLE.replace("\n", "\r\n") + "f 1 2 3\r\n",
        TRIANGLE.replace("\n", "\r") + "f 1 2 3",
        TRIANGLE.replace(" ", "\t") + "\tf\t1  2\t3  \n",
        "# head\n" + TRIANGLE.replace("\n", " # tail\n") + "\n\nf 1 2 3 # \\\n# C:\\models\\\n",
        "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n 2 \\\n 3\n",
        "\ufeff" + TRIANGLE + "f 1 2 3\n",
        TRIANGLE + "vn 0 0 1\nf 1//1 2//1 3//1\n",
        TRIANGLE + "f 1/ 2/ 3/\n",
    ],
)
def test_ways_of_writing_the_same_triangle(text: str) -> None:
    mesh = read(text)
    assert corners(mesh) == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
    assert not mesh.has_uv.any()
    assert mesh.warnings == ()


def test_vertex_colors_are_left_out_with_a_warning() -> None:
    mesh = read("v 0 0 0 .5 .5 .5\nv 1 0 0 1 1 1\nv 0 1 0 0 0 0\nf 1 2 3\n")
    assert corners(mesh) == [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
    assert mesh.warnings == ("a.obj: left out vertex colors, first in line 1",)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_colors_in_comments_are_left_out_with_a_warning(end: str) -> None:
    text = "# ZBrush\n#MRGB ffff0000ff00ff00ff0000ff\n" + TRIANGLE + "f 1 2 3\n#MRGBA is none\n"
    mesh = read(text.replace("\n", end))
    assert mesh.warnings == ("a.obj: left out vertex colors, first in line 2",)
    assert read("#MRGB ff\n" + TRIANGLE + "f 1 2 3\n").warnings[0].endswith("first in line 1")
    assert read(TRIANGLE + "f 1 2 3 # of #MRGB x\n").warnings == ()


@pytest.mark.parametrize("words", ["nan nan nan", "0 1.#INF 0", "1e999 0 0", "x", "0 0"])
def test_a_position_that_no_face_uses_may_be_no_number(words: str) -> None:
    mesh = read(f"v {words}\n" + TRIANGLE + "f 2 3 4\nf -3 -2 -1\n")
    assert mesh.corners[0].tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert mesh.warnings == (
        "a.obj: left out positions that are no finite numbers and that no face uses, "
        "first in line 1",
    )


def test_many_positions_that_are_no_numbers_end_the_reading() -> None:
    with pytest.raises(MeshError, match=r"a\.obj:1001: expected 3 or more finite numbers"):
        read("v x\n" * 100_000)


def test_faces_with_and_without_uv_mix() -> None:
    mesh = read(TRIANGLE + "vt 0 0\nf 1/1 2/1 3/1\nf 3 2 1\nf 1/1 2 3/1\n")
    assert mesh.has_uv.tolist() == [True, False, False]
    assert "texture coordinates in some corners only of 1 face" in mesh.warnings[0]


def test_polygons_keep_their_uvs_and_material() -> None:
    mesh = read(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n"
    )
    np.testing.assert_array_equal(mesh.corners[:, :, :2], mesh.corner_uvs)
    assert len(mesh.faces) == 2


def test_what_is_no_surface_is_named() -> None:
    mesh = read(TRIANGLE + "l 1 2\nf 1 2\nf 1 2 3\nshape x\n")
    assert len(mesh.faces) == 1
    for what, line in [("'l'", 4), ("fewer than three", 5), ("'shape'", 7)]:
        assert any(what in text and f"line {line}" in text for text in mesh.warnings)


def test_a_one_number_uv_has_v_zero() -> None:
    mesh = read(TRIANGLE + "vt .5\nvt .25 .75 0\nf 1/1 2/2 3/2\n")
    assert mesh.uvs.tolist() == [[0.5, 0.0], [0.25, 0.75]]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("v 0 0 nan\nf 1 1 1\n", "a.obj:1: expected 3 or more finite numbers, found '0 0 nan'"),
        ("v 0 0 0\nv 0 inf 0\nf 1 2 1\n", "a.obj:2: "),
        ("v 0 0 1e999\nf 1 1 1\n", "a.obj:1: "),
        ("v 0 0\nf 1 1 1\n", "a.obj:1: expected 3"),
        ("v 0 0 zero\nf 1 1 1\n", "found '0 0 zero'"),
        (TRIANGLE + "f 1 2 4\n", "a.obj:4: expected a vertex index up to 3, found 4"),
        (TRIANGLE + "f 1 2 3\nf 1 2 3 9\n", "a.obj:5: expected a vertex index up to 3, found 9"),
        (TRIANGLE + "f 1 2 0\n", "a.obj:4: expected an index"),
        (TRIANGLE + "f 1 2 -4\n", "from -1 down to -3, found '-4'"),
        (TRIANGLE + "f 1 2 x\n", "found 'x'"),
        (TRIANGLE + "f 1 2 99999999999999999999\n", "a.obj:4: expected an index"),
        ("v 0 \\\n0 \\\nx\nf 1 1 1\n", "a.obj:1: "),
    ],
)
def test_errors_name_file_and_line(text: str, expected: str) -> None:
    with pytest.raises(MeshError) as caught:
        read(text)
    assert expected in str(caught.value)


def test_a_binary_file_gives_few_warnings() -> None:
    noise = b"\n".join(b"k%d 1" % number for number in range(1000))
    assert len(read(noise + b"\n" + TRIANGLE.encode() + b"f 1 2 3").warnings) == 20


STATEMENTS = st.lists(
    st.one_of(
        st.binary(max_size=20),
        st.tuples(
            st.sampled_from([b"v", b"vt", b"f", b"usemtl", b"mtllib", b"\\", b"#"]),
            st.lists(
                st.sampled_from([b"1", b"-1", b"2/1", b"1//1", b"0", b"nan", b"1e308", b"-1/-1"]),
                max_size=7,
            ),
        ).map(lambda pair: b" ".join([pair[0], *pair[1]])),
    ),
    max_size=20,
).map(b"\n".join)


@given(st.one_of(st.binary(max_size=200), STATEMENTS))
def test_any_bytes_give_a_mesh_or_a_mesh_error(data: bytes) -> None:
    found = outcome(read, data)
    assert isinstance(found, TexturedMesh) or str(found).startswith("a.obj:")


WORDS = {
    "v": ["0", "1", ".5", "-2e3", "nan", "1e308", "x"],
    "vt": ["0", "1", ".5", "nan", "x"],
    "vn": ["0", "1", "-.5", "nan", "x"],
    "f": ["1", "2/1", "3//2", "1/2/3", "2/", "2//", "-1", "-1/-2", "0", "9", "3//0", "f", "x"],
}


@st.composite
def runs_of_lines(draw: st.DrawFn) -> str:
    """Long runs of each statement, with a few lines among them that have another form."""
    lines = [TRIANGLE + "vt 0 1\n" * 3 + "vn 0 1 0\n" * 3]
    for keyword in draw(st.lists(st.sampled_from(sorted(WORDS)), min_size=1, max_size=6)):
        plain = f"{keyword} " + {"f": "1/1/1 2/2 3"}.get(keyword, "0 1 .5") + "\n"
        run = [plain] * draw(st.integers(SHORTEST_RUN - 1, SHORTEST_RUN + 4))
        if draw(st.booleans()):
            words = draw(st.lists(st.sampled_from(WORDS[keyword]), max_size=7))
            end = draw(st.sampled_from(["\n", "\n", " \\\n", " \n", "\t\n"]))
            run.insert(draw(st.integers(0, len(run))), " ".join([keyword, *words]) + end)
        lines += [*run, "s 2\n" if draw(st.booleans()) else "o b\n"]
    return "".join(lines)


@given(runs_of_lines())
def test_many_lines_at_once_are_read_as_each_alone(text: str) -> None:
    # Lines with comments are read one by one.
    at_once, alone = outcome(read, text), outcome(read, text.replace("\n", " #\n"))
    if isinstance(alone, MeshError):
        assert str(at_once) == str(alone)
        return
    for name in ("positions", "faces", "uvs", "uv_faces", "face_materials", "creases"):
        np.testing.assert_array_equal(getattr(at_once, name), getattr(alone, name), name)
    assert at_once.warnings == alone.warnings


def test_names_of_any_encoding(tmp_path: Path) -> None:
    mesh = load_obj(
        tmp_path,
        b"mtllib a.mtl\nusemtl caf\xe9\n" + TRIANGLE.encode() + b"f 1 2 3\n",
        a_mtl=b"newmtl caf\xe9\nKd 1 0 0\n",
    )
    assert mesh.materials[0].name == "café"
    assert mesh.materials[0].base_color == (1.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("vt", ["nan nan", "-nan(ind) 0", "0 1.#QNAN", "inf 0", "0 -1.#IND00"])
def test_a_face_with_unusable_uvs_has_none(tmp_path: Path, vt: str) -> None:
    text = TRIANGLE + f"vt 0 0\nvt 1 0\nvt {vt}\nvt 0 1\nf 1/1 2/2 3/3\nf 3/4 2/2 1/1\n"
    mesh = load_obj(tmp_path, text)
    assert mesh.has_uv.tolist() == [False, True]
    assert mesh.corner_uvs[1].tolist() == [[0, 1], [1, 0], [0, 0]]
    assert "a.obj: texture coordinates of 1 face(s) are no finite numbers" in mesh.warnings[0]


@pytest.mark.parametrize("vt", ["vt", "vt a b", "vt .5,.5"])
def test_texture_coordinates_that_are_no_numbers_cost_their_faces_alone(
    tmp_path: Path, vt: str
) -> None:
    text = TRIANGLE + f"vt 0 0\nvt 1 0\n{vt}\nvt 0 1\nf 1/1 2/2 3/3\nf 3/4 2/2 1/1\n"
    mesh = load_obj(tmp_path, text)
    assert mesh.has_uv.tolist() == [False, True]
    assert mesh.warnings[0].startswith("a.obj: left out texture coordinates")
    assert mesh.warnings[0].endswith("first in line 6")


def test_texture_coordinates_that_are_not_there_cost_their_face_alone(tmp_path: Path) -> None:
    mesh = load_obj(tmp_path, TRIANGLE + "vt 0 0\nvt 1 0\nf 1/1 2/2 3/9\nf 3/1 2/2 1/2\n")
    assert mesh.has_uv.tolist() == [False, True]
    assert mesh.warnings[0].startswith("a.obj:6: expected a texture coordinate index up to 2")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-be"])
def test_wide_text(tmp_path: Path, encoding: str) -> None:
    mark = "" if encoding == "utf-16" else "\ufeff"
    text = (mark + TRIANGLE + "f 1 2 3\n").encode(encoding)
    assert len(load_obj(tmp_path, text).faces) == 1


@pytest.mark.parametrize("names", [" #" * 100_000, " " * 200_000 + "x", "x " * 100_000])
def test_absurd_names_take_neither_memory_nor_time(tmp_path: Path, names: str) -> None:
    text = f"mtllib {names}\nusemtl {names}\n" + TRIANGLE + "f 1 2 3\n"
    tracemalloc.start()
    load_obj(tmp_path, text)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 20 * len(text) + 1_000_000
