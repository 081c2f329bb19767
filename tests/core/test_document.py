"""A document's parts fit together, mesh parts with every copy of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nispcodec.core.document import Document
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MAX_PLACED_FACES, Placement
from nispcodec.core.network import MAX_CHARTS
from tests import tiny
from tests.infer.parts import cube, part_of

PART = part_of(cube(0.5), charts=2)


def with_mesh(**changes: Any) -> Document:
    """Two materials, no field, a cube of two charts that is changed so."""
    return replace(tiny.document(), field=None, meshes=(replace(PART, **changes),))


def copies(count: int) -> tuple[Placement, ...]:
    return (Placement(),) * count


def test_a_field_or_a_mesh_is_there() -> None:
    assert len(with_mesh().chart_materials) == 2
    with pytest.raises(FormatError, match=r"document\.parts"):
        replace(with_mesh(), meshes=())


def test_materials_of_meshes_and_their_copies_exist() -> None:
    other = Placement(materials=np.array([1, 2], np.int32))
    wrong: list[dict[str, Any]] = [
        {"chart_materials": np.array([0, 2], np.int32)},
        {"placements": (other,)},
    ]
    for changes in wrong:
        with pytest.raises(FormatError, match="mesh part, field materials: expected 0 to 1"):
            with_mesh(**changes)


def test_charts_of_all_copies_are_bounded() -> None:
    assert len(with_mesh(placements=copies(MAX_CHARTS // 2)).chart_has_uv) == MAX_CHARTS - 1
    with pytest.raises(FormatError, match="field charts: expected at most 65535 with all copies"):
        with_mesh(placements=copies(MAX_CHARTS // 2 + 1))


def test_faces_of_all_copies_are_bounded() -> None:
    with pytest.raises(FormatError, match="field placed_faces"):
        with_mesh(placements=copies(MAX_PLACED_FACES // 12 + 1))
