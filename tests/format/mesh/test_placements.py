"""Placements come back as they were; what is no placement is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import Placement
from nispcodec.format.mesh import decode, encode
from tests.format.mesh.parts import box, grid

TURNED = Placement(
    rotation=(0.5, -0.5, 0.5, 0.5),
    offset=(0.25, -3.0, 0.0),
    scale=2.5,
    mirrored=True,
    uv_scale=(1.0, 0.5),
    uv_offset=(0.125, 0.0),
    materials=np.array([7], np.int32),
)


def test_what_comes_back() -> None:
    made = replace(grid(), placements=(Placement(), TURNED, Placement(offset=(1.0, 0.0, 0.0))))
    (found,) = decode(encode((made,)))
    assert found.placements[0] == Placement()
    assert found.placements[2] == made.placements[2]
    materials = found.placements[1].materials
    assert materials is not None
    assert materials.tolist() == [7]
    assert replace(found.placements[1], materials=None) == replace(TURNED, materials=None)


def test_one_that_stays_in_place_is_a_bit() -> None:
    other = replace(box(), placements=(Placement(offset=(0.5, 0.1, 0.3)),))
    assert len(encode((other,))) >= len(encode((box(),))) + 12


def test_materials_follow_their_charts() -> None:
    flat = grid(2)
    charts = np.array([1, 1, 0, 0, 2, 2, 2, 2], np.int32)
    copy = Placement(materials=np.array([10, 11, 12], np.int32))
    made = replace(
        flat,
        face_charts=charts,
        chart_materials=np.array([0, 1, 2], np.int32),
        chart_has_uv=np.ones(3, np.bool_),
        placements=(copy,),
    )
    (found,) = decode(encode((made,)))
    materials = found.placements[0].materials
    assert materials is not None
    assert (materials == found.chart_materials + 10).all()


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        (Placement(materials=np.array([-1], np.int32)), "materials"),
        (Placement(scale=1e-50), "scale"),
        (Placement(offset=(0.0, 1e39, 0.0)), "offset"),
    ],
    ids=["negative material", "scale that float32 has not", "offset that float32 has not"],
)
def test_refused(wrong: Placement, field: str) -> None:
    with pytest.raises(FormatError, match=f"MESH, field {field}"):
        encode((replace(box(), placements=(wrong,)),))
