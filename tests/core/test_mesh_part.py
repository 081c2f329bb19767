from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MAX_PLACED_FACES, Placement, check_placed_faces
from tests.infer.parts import cube, part_of

PART = part_of(cube(2.0), charts=2)


def test_integers_become_numbers() -> None:
    np.testing.assert_allclose(PART.normalized().min(axis=0), [-1, -1, -1], atol=1e-12)
    np.testing.assert_allclose(PART.normalized().max(axis=0), [1, 1, 1], atol=1e-9)
    np.testing.assert_allclose(PART.asset_uvs(), PART.normalized()[:, :2], atol=1e-12)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("faces", np.full((12, 3), 99, np.int32)),
        ("faces", np.zeros((11, 3), np.int32)),
        ("positions", np.full((8, 3), -1, np.int32)),
        ("positions", np.full((8, 3), 1 << 20, np.int32)),
        ("uv_faces", np.full((12, 3), -1, np.int32)),
        ("face_charts", np.full(12, 2, np.int32)),
        ("chart_has_uv", np.ones(3, np.bool_)),
        ("sheet", np.zeros(3, np.bool_)),
        ("creases", np.zeros((12, 2), np.bool_)),
        ("step", 0.0),
        ("step", np.inf),
        ("origin", (0.0, np.nan, 0.0)),
        ("uv_step", (1.0, -np.inf)),
        ("uv_origin", (np.nan, 0.0)),
        ("placements", ()),
    ],
)
def test_what_does_not_fit_is_refused(field: str, value: Any) -> None:
    with pytest.raises(FormatError, match=field):
        replace(PART, **{field: value})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("rotation", (1.0, 1.0, 0.0, 0.0)),
        ("rotation", (np.nan, 0.0, 0.0, 0.0)),
        ("offset", (0.0, np.inf, 0.0)),
        ("scale", 0.0),
        ("scale", -1.0),
        ("scale", np.inf),
        ("uv_scale", (np.nan, 1.0)),
        ("uv_offset", (0.0, -np.inf)),
    ],
)
def test_what_is_no_placement_is_refused(field: str, value: Any) -> None:
    with pytest.raises(FormatError, match=f"field {field}"):
        Placement(**{field: value})


def test_materials_of_a_copy_are_one_for_each_chart() -> None:
    copies = tuple(Placement(materials=np.zeros(n, np.int32)) for n in (2, 3))
    assert replace(PART, placements=copies[:1]).placed_charts == 2
    with pytest.raises(FormatError, match=r"field placement_materials: expected shape \(2,\)"):
        replace(PART, placements=copies)


def test_faces_with_all_copies_are_bounded() -> None:
    assert replace(PART, placements=(Placement(),) * 3).placed_faces == 36
    check_placed_faces(MAX_PLACED_FACES)
    with pytest.raises(FormatError, match="field placed_faces"):
        check_placed_faces(MAX_PLACED_FACES + 1)


def test_faces_of_charts_without_uv_have_none() -> None:
    bare = replace(
        PART,
        chart_has_uv=np.array([True, False]),
        uv_faces=np.where((PART.face_charts == 1)[:, None], -1, PART.uv_faces),
    )
    assert not bare.chart_has_uv.all()
    with pytest.raises(FormatError, match="uv_faces"):
        replace(bare, uv_faces=PART.uv_faces)
