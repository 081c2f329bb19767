"""Fewer triangles of what is there: seams closed, bodies kept, nothing made up."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.core.arrays import IntArray
from nispcodec.simplify import collapse
from nispcodec.simplify.collapse import collapsed
from nispcodec.simplify.config import CollapseConfig
from nispcodec.simplify.curves import border_sides
from nispcodec.simplify.triangles import Triangles
from tests.simplify.meshes import area, ball, bare_ball, cards, half_dressed_ball, sheet


@pytest.mark.parametrize("triangles", [ball(), bare_ball(), half_dressed_ball(), sheet()])
def test_about_as_many_faces_as_asked_for(triangles: Triangles) -> None:
    fewer = collapsed(triangles, len(triangles) // 4)
    assert len(triangles) // 8 < len(fewer) <= len(triangles) // 3


@pytest.mark.parametrize("triangles", [ball(), bare_ball(), half_dressed_ball()])
def test_a_closed_body_stays_closed(triangles: Triangles) -> None:
    assert not border_sides(collapsed(triangles, 60)).any()


def test_positions_and_uvs_are_some_of_the_given_ones() -> None:
    given = ball()
    fewer = collapsed(given, 80)
    assert {tuple(row) for row in fewer.positions} <= {tuple(row) for row in given.positions}
    assert {tuple(row) for row in fewer.uvs} <= {tuple(row) for row in given.uvs}


def test_patches_keep_their_uvs() -> None:
    fewer = collapsed(ball(), 80)
    below = fewer.corner_uvs.mean(axis=(1, 2)) > 0.5
    assert len(np.unique(fewer.patches[below])) == 1
    assert len(np.unique(fewer.patches)) == 2


def test_all_faces_are_the_same_triangles() -> None:
    given = ball()
    assert collapsed(given, len(given)) is given


def test_many_small_bodies_do_not_vanish() -> None:
    given = cards()
    fewer = collapsed(given, 60)
    assert area(fewer) > 0.97 * area(given)


def test_small_bodies_may_go_where_they_are_no_notable_part() -> None:
    given = cards()
    assert len(collapsed(given, 60, CollapseConfig(notable_area=1.0))) <= 60


def test_faces_whose_corners_share_a_place_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """meshoptimizer leaves some at seams, where a vertex has one number for each chart."""
    triangles = ball()

    def folded(faces: IntArray, *_: object) -> IntArray:
        # Two corners of the first face are one vertex, as it is seen from either chart.
        return np.concatenate([faces[:1, [0, 1, 0]], faces])

    monkeypatch.setattr(collapse, "fewer_triangles", folded)
    found = collapsed(triangles, len(triangles) - 1)
    assert len(found) == len(triangles)
    assert (found.faces != np.roll(found.faces, 1, axis=1)).all()


@pytest.mark.parametrize("triangles", [ball(), cards()])
def test_corners_that_are_kept_stay(triangles: Triangles) -> None:
    chosen = np.flatnonzero(triangles.positions[:, 0] > triangles.positions[:, 0].max() - 0.2)
    kept = np.isin(triangles.faces, chosen)
    fewer = collapsed(triangles, 60, kept=kept)
    assert {tuple(row) for row in triangles.positions[chosen]} <= set(map(tuple, fewer.positions))
