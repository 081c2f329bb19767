from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import ArrayLike

from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.errors import MeshError
from nispcodec.io.cleanup import clean


def mesh(
    positions: ArrayLike,
    faces: ArrayLike,
    uvs: ArrayLike = (),
    uv_faces: ArrayLike | None = None,
    face_materials: ArrayLike | None = None,
) -> TexturedMesh:
    corners = np.array(faces, dtype=np.int32).reshape(-1, 3)
    return TexturedMesh(
        positions=np.array(positions, dtype=float),
        faces=corners,
        uvs=np.array(uvs, dtype=float).reshape(-1, 2),
        uv_faces=np.full_like(corners, -1)
        if uv_faces is None
        else np.array(uv_faces, dtype=np.int32),
        face_materials=np.array(
            face_materials if face_materials is not None else [0] * len(corners), dtype=np.int32
        ),
        materials=(Material(), Material()),
    )


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def test_a_clean_mesh_stays_as_it_is() -> None:
    before = mesh(
        SQUARE, [(0, 1, 2), (0, 2, 3)], [(0, 0), (1, 0), (1, 1)], [(0, 1, 2), (-1, -1, -1)]
    )
    after = clean(before, "a.obj")
    assert after.warnings == ()
    for name in ("positions", "faces", "uvs", "uv_faces", "face_materials"):
        np.testing.assert_array_equal(getattr(before, name), getattr(after, name))


@pytest.mark.parametrize(
    "third",
    [(1, 0, 0), (2, 0, 0), (0.5, 1e-13, 0), (-3, 0, 0)],
    ids=["same", "beyond", "rounding", "behind"],
)
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_degenerate_faces_go_at_any_scale(third: tuple[float, float, float], scale: float) -> None:
    positions = np.array([*SQUARE, third], dtype=float) * scale
    after = clean(mesh(positions, [(0, 1, 4), (0, 1, 2), (0, 2, 3)]), "a.obj")
    assert len(after.faces) == 2
    assert after.warnings == ("dropped 1 degenerate face", "dropped 1 unreferenced vertex")


def test_a_thin_triangle_is_a_surface() -> None:
    positions = [(0, 0, 0), (1, 0, 0), (0.5, 1e-6, 0)]
    assert clean(mesh(positions, [(0, 1, 2)]), "a.obj").warnings == ()


def test_duplicates_go_whatever_corner_they_start_from() -> None:
    after = clean(mesh(SQUARE, [(0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 3)]), "a.obj")
    assert after.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert after.warnings == ("dropped 2 duplicate faces",)


def test_duplicates_are_compared_by_value() -> None:
    positions = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (-0.0, 0, 0), (1, 0, 0), (0, 1, 0)]
    after = clean(mesh(positions, [(0, 1, 2), (3, 4, 5)]), "a.obj")
    assert len(after.faces) == 1


def test_faces_that_differ_in_anything_stay() -> None:
    uvs = [(0, 0), (1, 0), (1, 1)]
    faces = [(0, 1, 2), (0, 2, 1), (0, 1, 2), (0, 1, 2)]
    uv_faces = [(0, 1, 2), (0, 2, 1), (1, 2, 0), (0, 1, 2)]
    before = mesh(SQUARE[:3], faces, uvs, uv_faces, [0, 0, 0, 1])
    assert clean(before, "a.obj").warnings == ()


def test_vertices_of_equal_position_are_not_merged() -> None:
    positions = [*SQUARE[:3], *SQUARE[:1], *SQUARE[2:]]
    assert len(clean(mesh(positions, [(0, 1, 2), (3, 4, 5)]), "a.obj").positions) == 6


def test_unreferenced_rows_go_and_the_rest_keeps_its_order() -> None:
    before = mesh(
        [(9, 9, 9), *SQUARE], [(1, 2, 3)], [(5, 5), (0, 0), (6, 6), (1, 0), (1, 1)], [(1, 3, 4)]
    )
    after = clean(before, "a.obj")
    assert after.corners.tolist() == before.corners.tolist()
    assert after.corner_uvs.tolist() == before.corner_uvs.tolist()
    assert after.warnings == (
        "dropped 2 unreferenced vertices",
        "dropped 2 unreferenced texture coordinates",
    )


def test_a_position_that_no_face_uses_may_be_anywhere() -> None:
    after = clean(mesh([*SQUARE, (1e200, 0, 0)], [(0, 1, 2), (0, 2, 3)]), "a.obj")
    assert len(after.positions) == 4
    assert after.warnings == ("dropped 1 unreferenced vertex",)


@pytest.mark.parametrize("faces", [[], [(0, 0, 1)]])
@pytest.mark.parametrize(("count", "end"), [(1, "w0)"), (5, "; w4)"), (6, "; w4; ...)")])
def test_an_error_says_what_was_left_out(faces: ArrayLike, count: int, end: str) -> None:
    warnings = tuple(f"w{number}" for number in range(count))
    with pytest.raises(MeshError) as caught:
        clean(replace(mesh(SQUARE, faces), warnings=warnings), "a.obj")
    assert " (w0" in str(caught.value)
    assert str(caught.value).endswith(end)


@pytest.mark.parametrize(
    ("positions", "faces", "message"),
    [
        (SQUARE, [], "at least one face, found none"),
        (SQUARE, [(0, 0, 1), (1, 1, 1)], "with an area, found 2 degenerate faces"),
        ([(0, 0, 0), (1, 0, 0), (0, 1e-9, 0)], [(0, 1, 2)], "with an area, found 1 degenerate"),
        ([(0, 0, 0), (1e200, 0, 0), (0, 1, 0)], [(0, 1, 2)], "found 1e.200"),
    ],
)
def test_nothing_to_encode(positions: ArrayLike, faces: ArrayLike, message: str) -> None:
    with pytest.raises(MeshError, match=rf"a\.obj: expected .*{message}"):
        clean(mesh(positions, faces), "a.obj")
