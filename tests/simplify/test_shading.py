"""Simplified triangles are shaded as their source is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.asset import Material
from nispcodec.core.creases import fan_normals, sharp_sides
from nispcodec.core.document import Document, Frame
from nispcodec.core.mesh_part import Placement
from nispcodec.extract.mesh_parts import joined
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.quantize import quantized
from nispcodec.simplify.shading import shaded
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles
from nispcodec.simplify.triangles import joined as joined_triangles
from tests.geometry import shapes
from tests.simplify.meshes import UNIT, ball

BOX = Triangles.of(shapes.box_asset(), UNIT)
NOTHING = np.zeros((12, 3), np.bool_)


def with_creases(triangles: Triangles, angle: float) -> Triangles:
    return replace(triangles, creases=sharp_sides(triangles.faces, triangles.corners, angle))


def test_where_nobody_said_nothing_is_written_and_sharp_edges_break() -> None:
    part = quantized(BOX, 8, 8)
    assert not part.creases.any()
    assert part.shading_breaks.sum() == 24


def test_what_readers_find_themselves_is_not_written() -> None:
    assert not quantized(with_creases(BOX, 1.0), 8, 8).creases.any()


def test_a_box_whose_shading_is_smooth_stays_so() -> None:
    part = quantized(replace(BOX, creases=NOTHING), 8, 8)
    assert part.creases.sum() == 2
    places = part.faces.astype(np.int64)
    rows, _ = fan_normals(places, part.normalized()[places], part.shading_breaks)
    assert len(rows) == 8


@pytest.mark.parametrize("flat", [True, False])
def test_facets_stay_facets_and_smooth_stays_smooth(flat: bool) -> None:
    source = with_creases(ball(6), 0.0 if flat else 3.0)
    fewer = shaded(Source(source), collapsed(source, 200))
    turned = sharp_sides(fewer.faces, fewer.corners, 0.1)
    assert fewer.creases is not None
    share = fewer.creases[turned].mean()
    assert share > 0.5 if flat else share < 0.1
    assert shaded(Source(ball()), collapsed(ball(), 150)).creases is None


def test_each_body_of_a_part_is_shaded_its_own_way() -> None:
    flat, smooth = with_creases(ball(6), 0.0), with_creases(ball(), 3.0)
    fewer = [collapsed(flat, 200), collapsed(smooth, 60)]
    aside = np.array([3.0, 0, 0])
    both, source = (
        joined_triangles(first, replace(second, positions=second.positions + aside))
        for first, second in (fewer, (flat, smooth))
    )
    found = shaded(Source(source), both)
    turned = sharp_sides(both.faces, both.corners, 0.1)
    assert found.creases is not None
    first = np.arange(len(both)) < len(fewer[0])
    assert found.creases[first][turned[first]].mean() > 0.5
    assert found.creases[~first].mean() < 0.05


def test_copies_that_are_mirrored_break_over_the_same_edges() -> None:
    part = quantized(with_creases(BOX, 1.0), 8, 8)
    marked = np.zeros((12, 3), np.bool_)
    marked[0, 1] = True
    part = replace(part, creases=marked, placements=(Placement(mirrored=True),))
    frame = Frame((0.0, 0.0, 0.0), 1.0)
    mesh = joined(Document(frame, (Material(),) * 2, (), meshes=(part,)), None)
    assert mesh.creases is not None
    ends = np.stack([mesh.corners, np.roll(mesh.corners, -1, axis=1)], axis=2)[mesh.creases]
    corners = part.normalized()[part.faces]
    wanted = np.stack([corners[0, 1], corners[0, 2]]) * [-1, 1, 1]
    assert np.allclose(np.sort(ends[0], axis=0), np.sort(wanted, axis=0))
