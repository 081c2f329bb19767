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
from nispcodec.io.read.ply import read_ply
from tests.io.files import image, outcome

NOWHERE = Folder(Path("/nonexistent"))
VERTEX = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
FACE = "element face {}\nproperty list uchar int vertex_indices\n"
SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def text(header: str, body: str, format: str = "ascii") -> bytes:
    return f"ply\nformat {format} 1.0\n{header}end_header\n{body}".encode()


def read(data: bytes, folder: Folder = NOWHERE) -> TexturedMesh:
    return read_ply(data, "a.ply", folder)


def test_text() -> None:
    mesh = read(text(VERTEX + FACE.format(2), SQUARE + "3 0 1 2\n3 0 2 3\n"))
    assert mesh.positions.tolist() == CORNERS
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert not mesh.has_uv.any()


@pytest.mark.parametrize("spelled", ["vertex_index", "vertex_indexes"])
def test_other_spellings_of_the_list_of_corners(spelled: str) -> None:
    header = VERTEX + FACE.format(2).replace("vertex_indices", spelled)
    header += "property list uchar float texcoord\n"
    body = SQUARE + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"
    mesh = read(text(header, body))
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.corner_uvs[1].tolist() == [[0, 0], [1, 1], [0, 1]]


def test_polygons() -> None:
    mesh = read(text(VERTEX + FACE.format(2), SQUARE + "4 0 1 2 3\n3 3 2 1\n"))
    assert len(mesh.faces) == 3


def test_faces_of_fewer_than_three_corners_are_left_out_with_what_is_theirs() -> None:
    header = VERTEX + FACE.format(3) + "property list uchar float texcoord\n"
    body = SQUARE + "2 0 1 4 9 9 9 9\n3 0 1 2 6 0 0 1 0 1 1\n0 0\n"
    mesh = read(text(header, body))
    assert mesh.faces.tolist() == [[0, 1, 2]]
    assert mesh.corner_uvs[0].tolist() == [[0, 0], [1, 0], [1, 1]]
    assert mesh.warnings == ("a.ply: left out 2 face(s) of fewer than three corners",)


@pytest.mark.parametrize("body", ["5 0 1 2 3 -1", "9 0 1 2 3 -1 1 2 -1 -1", "4 0 1 2 3"])
def test_triangle_strips(body: str) -> None:
    strips = "element tristrips 1\nproperty list int int vertex_indices\n"
    mesh = read(text(VERTEX + strips, SQUARE + body))
    assert mesh.faces.tolist() == [[0, 1, 2], [1, 3, 2]]


def test_strips_beside_an_empty_table_of_faces() -> None:
    strips = "element tristrips 1\nproperty list int int vertex_indices\n"
    mesh = read(text(VERTEX + FACE.format(0) + strips, SQUARE + "4 0 1 3 2\n"))
    assert mesh.faces.tolist() == [[0, 1, 3], [1, 2, 3]]
    assert mesh.warnings == ()


def test_strips_one_after_the_other_begin_anew() -> None:
    strips = "element tristrips 2\nproperty list int int vertex_indices\n"
    mesh = read(text(VERTEX + strips, SQUARE + "7 0 1 2 -1 3 2 1\n3 1 2 3"))
    assert mesh.faces.tolist() == [[0, 1, 2], [3, 2, 1], [1, 2, 3]]


def test_a_strip_longer_than_any_polygon() -> None:
    strip = np.arange(70_000) % 4
    strips = "element tristrips 1\nproperty list int int vertex_indices\n"
    data = text(VERTEX + strips, "", "binary_little_endian")
    data += np.array(CORNERS, "<f4").tobytes()
    data += struct.pack("<i", len(strip)) + strip.astype("<i4").tobytes()
    assert len(read(data).faces) == len(strip) - 2


@pytest.mark.parametrize(
    ("owner", "name"),
    [("vertex", "red"), ("vertex", "diffuse_red"), ("vertex", "ambient_red"), ("face", "red")],
)
def test_colors_are_left_out_by_name(owner: str, name: str) -> None:
    color = f"property uchar {name}\n"
    vertex, face = (color if owner == each else "" for each in ("vertex", "face"))
    body = SQUARE.replace("\n", " 7\n") if vertex else SQUARE
    mesh = read(
        text(VERTEX + vertex + FACE.format(1) + face, f"{body}3 0 1 2{' 7' if face else ''}\n")
    )
    assert mesh.warnings == (f"a.ply: left out {owner} colors",)


def test_alpha_alone_and_colors_of_corners_are_left_out_by_name() -> None:
    header = VERTEX + "property uchar alpha\n" + FACE.format(1)
    header += "property list uchar float color\n"
    body = SQUARE.replace("\n", " 7\n") + "3 0 1 2 9 1 0 0 1 0 0 1 0 0\n"
    assert read(text(header, body)).warnings == (
        "a.ply: left out vertex property 'alpha'",
        "a.ply: left out face property 'color'",
    )


def test_what_comes_after_the_last_row_is_said() -> None:
    header = VERTEX + FACE.format(1)
    said = "after the last row of the header's elements"
    mesh = read(text(header, SQUARE + "3 0 1 2\n3 0 2 3\n"))
    assert mesh.faces.tolist() == [[0, 1, 2]]
    assert mesh.warnings == (f"a.ply: left out 4 numbers {said}",)
    body = np.array(CORNERS, "<f4").tobytes() + struct.pack("<B3i", 3, 0, 1, 2)
    whole = text(header, "", "binary_little_endian") + body
    assert read(whole).warnings == ()
    assert read(whole + b"tail\n").warnings == (f"a.ply: left out 5 bytes {said}",)


def test_what_else_strips_hold_is_said() -> None:
    strips = "element tristrips 1\nproperty list int int vertex_indices\nproperty int group\n"
    mesh = read(text(VERTEX + strips, SQUARE + "4 0 1 2 3 7"))
    assert mesh.warnings == ("a.ply: left out tristrips property 'group'",)


def test_a_line_of_the_header_without_a_keyword_is_left_out_with_a_warning() -> None:
    header = "Created by a tool - www.example.org\n" + VERTEX + FACE.format(1)
    mesh = read(text(header, SQUARE + "3 0 1 2\n"))
    assert len(mesh.faces) == 1
    assert "a.ply:3: left out a line of the header" in mesh.warnings


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_the_header_ends_at_a_line_of_its_own(end: str) -> None:
    header = "comment end_header of a tool\n" + VERTEX + FACE.format(1)
    data = text(header, SQUARE + "3 0 1 2\n").replace(b"\n", end.encode())
    assert len(read(b"\xef\xbb\xbf" + data).faces) == 1


@pytest.mark.parametrize("key", ["texture_file", "texture:", "TextureFile:", "texture"])
def test_other_comments_that_name_an_image(tmp_path: Path, key: str) -> None:
    data = text(f"comment {key} my wood.png\n" + VERTEX + FACE.format(1), SQUARE + "3 0 1 2\n")
    assert read(data).warnings == ("a.ply: image 'my wood.png' not found",)
    (tmp_path / "my wood.png").write_bytes(image())
    assert len(read(data, Folder(tmp_path)).textures) == 1


def test_an_unreadable_image_is_left_out(tmp_path: Path) -> None:
    (tmp_path / "w.png").write_bytes(b"no image")
    data = text("comment TextureFile w.png\n" + VERTEX + FACE.format(1), SQUARE + "3 0 1 2\n")
    assert "w.png: expected an image" in read(data, Folder(tmp_path)).warnings[0]


@pytest.mark.parametrize("unusable", ["nan", "inf", "-nan(ind)", "1.#QNAN"])
def test_an_unusable_position_that_no_face_has_costs_itself_alone(unusable: str) -> None:
    body = SQUARE.replace("0 1 0", f"0 {unusable} 0") + "3 0 1 2\n"
    mesh = read(text(VERTEX + FACE.format(1), body))
    assert mesh.corners.tolist() == [CORNERS[:3]]
    assert mesh.warnings == (
        "a.ply: left out 1 vertex without finite coordinates, which no face has",
    )


@pytest.mark.parametrize("unusable", ["nan", "inf", "-nan(ind)", "1.#QNAN"])
def test_a_face_with_unusable_uvs_has_none(unusable: str) -> None:
    header = VERTEX + "property float s\nproperty float t\n" + FACE.format(2)
    body = f"0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 {unusable}\n3 0 1 2\n3 0 2 3\n"
    mesh = read(text(header, body))
    assert mesh.has_uv.tolist() == [True, False]
    assert "texture coordinates of 1 face(s) are no finite numbers" in mesh.warnings[0]


@pytest.mark.parametrize(("format", "order"), [("little", "<"), ("big", ">")])
def test_binary_with_columns_we_do_not_know(format: str, order: str) -> None:
    header = "comment made by hand\n" + VERTEX + "property uchar quality\n" + FACE.format(1)
    header += "property short flags\nelement edge 1\nproperty int vertex1\n"
    body = b"".join(struct.pack(order + "fffB", *corner, 7) for corner in CORNERS)
    body += struct.pack(order + "B4ih", 4, 0, 1, 2, 3, -1) + struct.pack(order + "i", 5)
    mesh = read(text(header, "", f"binary_{format}_endian") + body)
    assert mesh.positions.tolist() == CORNERS
    assert len(mesh.faces) == 2
    assert mesh.warnings == (
        "a.ply: left out element 'edge'",
        "a.ply: left out vertex property 'quality'",
        "a.ply: left out face property 'flags'",
    )


@pytest.mark.parametrize(
    "names",
    [
        ("s", "t"),
        ("u", "v"),
        ("texture_u", "texture_v"),
        ("texture_s", "texture_t"),
        ("s0", "t0"),
        ("u0", "v0"),
        ("tu", "tv"),
        ("tx", "ty"),
    ],
)
def test_vertex_uvs(names: tuple[str, str]) -> None:
    header = VERTEX + "".join(f"property float {name}\n" for name in names) + FACE.format(1)
    body = "0 0 0 .5 0\n1 0 0 1 .25\n1 1 0 0 7\n0 1 0 0 0\n3 0 1 2\n"
    mesh = read(text(header, body))
    assert mesh.corner_uvs[0].tolist() == [[0.5, 0], [1, 0.25], [0, 7]]
    assert mesh.warnings == ()


@pytest.mark.parametrize("textured", [False, True])
def test_tangents_are_no_uvs(textured: bool) -> None:
    names = ("s", "t") if textured else ()
    header = VERTEX + "".join(f"property float {name}\n" for name in (*names, "tx", "ty", "tz"))
    row = f" {'.5 .5 ' if textured else ''}0 1 0\n"
    mesh = read(text(header + FACE.format(1), SQUARE.replace("\n", row) + "3 0 1 2\n"))
    assert mesh.has_uv.all() == textured
    assert mesh.warnings == ("a.ply: left out vertex properties 'tx', 'ty', 'tz'",)


@pytest.mark.parametrize("listed", ["texcoord", "texcoords", "texture_coords", "uv"])
def test_corner_uvs_by_other_names(listed: str) -> None:
    header = VERTEX + FACE.format(1) + f"property list uchar float {listed}\n"
    mesh = read(text(header, SQUARE + "3 0 1 2 6 0 0 1 0 1 .25\n"))
    assert mesh.corner_uvs[0].tolist() == [[0, 0], [1, 0], [1, 0.25]]
    assert mesh.warnings == ()


def two_images(folder: Path, vertex: str, face: str, body: str) -> TexturedMesh:
    for name, color in (("red.png", (255, 0, 0)), ("green.png", (0, 255, 0))):
        (folder / name).write_bytes(image(color=color))
    names = "comment TextureFile red.png\ncomment TextureFile green.png\n"
    return read(text(names + VERTEX + vertex + FACE.format(2) + face, body), Folder(folder))


def test_vertices_may_say_the_texture_of_their_faces(tmp_path: Path) -> None:
    columns = "property float u\nproperty float v\nproperty int texnumber\n"
    rows = ["0 0 0 0 0 1", "1 0 0 1 0 1", "1 1 0 1 1 1", "0 1 0 0 1 0", "3 3 1 2", "3 0 1 2"]
    mesh = two_images(tmp_path, columns, "", "\n".join(rows))
    assert mesh.face_materials.tolist() == [0, 1]
    assert mesh.warnings == (
        "a.ply: face 0: expected one texnumber of all its vertices, found several: "
        "1 face as their first vertex",
    )


def test_images_that_no_face_shows_are_said(tmp_path: Path) -> None:
    lists = "property list uchar float texcoord\n"
    body = SQUARE + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n"
    assert two_images(tmp_path, "", lists, body).warnings == (
        "a.ply: left out image 'green.png': no face with texture coordinates has its texnumber",
    )
    assert two_images(tmp_path, "", "", SQUARE + "3 0 1 2\n3 0 2 3\n").warnings == (
        "a.ply: left out image 'red.png': no face has texture coordinates",
        "a.ply: left out image 'green.png': no face has texture coordinates",
    )


def test_corner_uvs_and_their_textures(tmp_path: Path) -> None:
    (tmp_path / "my wood.png").write_bytes(image())
    header = "comment TextureFile my wood.png\ncomment TextureFile gone.png\n" + VERTEX
    header += FACE.format(3) + "property list uchar float texcoord\nproperty int texnumber\n"
    body = SQUARE + "4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 1 2 0 1\n3 2 1 0 6 .1 .2 .3 .4 .5 .6 1\n"
    mesh = read(text(header, body), Folder(tmp_path))
    np.testing.assert_array_equal(mesh.corners[:2, :, :2], mesh.corner_uvs[:2])
    assert mesh.has_uv.tolist() == [True, True, False, True]
    assert mesh.corner_uvs[3].tolist() == [[0.1, 0.2], [0.3, 0.4], [0.5, 0.6]]
    assert mesh.face_materials.tolist() == [0, 0, 1, 1]
    assert mesh.textures[mesh.materials[0].maps["base_color"].texture].data == image()
    assert mesh.warnings == ("a.ply: image 'gone.png' not found",)


def test_vertex_colors_are_left_out_with_a_warning() -> None:
    header = VERTEX + "property uchar red\n" + FACE.format(1)
    mesh = read(text(header, SQUARE.replace("\n", " 9\n") + "3 0 1 2\n"))
    assert mesh.warnings == ("a.ply: left out vertex colors",)


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"plywood", "expected a header"),
        (b"ply\nformat ascii 1.0\n", "expected a header"),
        (text("", "", "ebcdic"), "expected a PLY format"),
        (text("element vertex many\n", ""), "a.ply:3: expected a PLY header"),
        (text("property float x\n", ""), "a.ply:3: expected a PLY header"),
        (text("element vertex 1\nproperty complex x\n", ""), "a.ply:4: expected a PLY header"),
        (text(VERTEX, SQUARE), "expected elements vertex and face"),
        (
            text(VERTEX + FACE.format(1).replace("vertex_indices", "loop"), SQUARE + "3 0 1 2"),
            "a list of vertex indices in element face, one of vertex_indices, vertex_index, "
            "vertex_indexes, found loop",
        ),
        (
            text(VERTEX + "element tristrips 1\nproperty int vertex_indices\n", SQUARE + "3"),
            "a list of vertex indices in element tristrips, one of vertex_indices, vertex_index, "
            "vertex_indexes, found no list",
        ),
        (text(VERTEX + FACE.format(1), SQUARE), "a.ply: face 0: expected numbers"),
        (
            text(VERTEX + FACE.format(1), SQUARE + "3 0 1 4"),
            "face 0: expected vertex indices below",
        ),
        (text(VERTEX + FACE.format(2), SQUARE + "3 0 1 2 4 0 1 2 -1"), "face 1: expected vertex"),
        (
            text(VERTEX + "property float x\n" + FACE.format(1), SQUARE),
            "properties of vertex: expected different names, found 'x' twice",
        ),
        (text(VERTEX + VERTEX + FACE.format(1), SQUARE), "elements: expected different names"),
        (text(VERTEX + FACE.format(1), SQUARE + "-3 0 1"), "face 0: expected numbers"),
        (
            text(VERTEX + FACE.format(1), "0 0 0 0 nan 0 0 0 0 1 1 1 3 0 1 2"),
            "vertex 1: expected finite",
        ),
        (text(VERTEX + FACE.format(0), "0 0 0 0 zero 0"), "vertex 1: expected numbers"),
        (text(VERTEX.replace(" y", " why") + FACE.format(0), SQUARE), "expected vertex properties"),
        (text(VERTEX, "", "binary_little_endian") + b"\0" * 40, "vertex 3: expected numbers"),
        (text("element vertex 2000000000\nproperty char x\n", "1"), "vertex 1: expected numbers"),
    ],
)
def test_errors_name_the_place(data: bytes, expected: str) -> None:
    with pytest.raises(MeshError) as caught:
        read(data)
    assert str(caught.value).startswith("a.ply:")
    assert expected in str(caught.value)


def test_texture_coordinates_that_do_not_fit_cost_their_face_alone() -> None:
    header = VERTEX + FACE.format(2) + "property list uchar float texcoord\n"
    mesh = read(text(header, SQUARE + "3 0 1 2 4 9 9 9 9\n3 0 2 3 6 0 0 1 0 1 1\n"))
    assert mesh.has_uv.tolist() == [False, True]
    assert mesh.corner_uvs[1].tolist() == [[0, 0], [1, 0], [1, 1]]
    assert "face 0: expected 6 texture coordinates, found 4" in mesh.warnings[0]


def test_a_texture_that_is_not_there_costs_its_face_alone(tmp_path: Path) -> None:
    (tmp_path / "t.png").write_bytes(image())
    header = f"comment TextureFile t.png\n{VERTEX}{FACE.format(2)}property int texnumber\n"
    mesh = read(text(header, SQUARE + "3 0 1 2 7\n3 0 2 3 0\n"), Folder(tmp_path))
    assert [bool(mesh.materials[each].maps) for each in mesh.face_materials] == [False, True]
    assert "face 0: expected a texnumber below 1, found 7" in mesh.warnings[0]


def test_what_else_a_file_holds_is_said() -> None:
    strips = "element tristrips 1\nproperty list int int vertex_indices\n"
    mesh = read(text(VERTEX + FACE.format(1) + strips, SQUARE + "3 0 1 2\n3 0 2 3\n"))
    assert mesh.warnings == ("a.ply: left out element 'tristrips'",)
    header = VERTEX + "property uchar r\n" + FACE.format(1)
    mesh = read(text(header, SQUARE.replace("\n", " 9\n") + "3 0 1 2\n"))
    assert mesh.warnings == ("a.ply: left out vertex colors",)


@given(st.binary(max_size=60), st.integers(0, 400), st.sampled_from(["ascii", "binary_big_endian"]))
def test_any_bytes_give_a_mesh_or_a_mesh_error(noise: bytes, at: int, format: str) -> None:
    whole = text(VERTEX + FACE.format(1), SQUARE + "3 0 1 2\n", format)
    for data in (noise, b"ply\n" + noise, whole[:at] + noise + whole[at + len(noise) :]):
        found = outcome(read, data)
        assert isinstance(found, TexturedMesh) or str(found).startswith("a.ply:")
