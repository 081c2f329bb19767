from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
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
        ("placements", ()),
    ],
)
def test_what_does_not_fit_is_refused(field: str, value: Any) -> None:
    with pytest.raises(FormatError, match=field):
        replace(PART, **{field: value})


def test_faces_of_charts_without_uv_have_none() -> None:
    bare = replace(
        PART,
        chart_has_uv=np.array([True, False]),
        uv_faces=np.where((PART.face_charts == 1)[:, None], -1, PART.uv_faces),
    )
    assert not bare.chart_has_uv.all()
    with pytest.raises(FormatError, match="uv_faces"):
        replace(bare, uv_faces=PART.uv_faces)
