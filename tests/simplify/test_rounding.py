"""Vertices slide to grid points that leave the surface where it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import Float64Array
from nispcodec.simplify.config import RoundingConfig
from nispcodec.simplify.retreat import crosses
from nispcodec.simplify.rounding import rounded_along
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import ball, sheet, triangles_of

CONFIG = RoundingConfig()
STEP = 0.02


def across(triangles: Triangles, ways: Float64Array) -> float:
    """Root of the mean square over all faces of how far ways (n, 3) of vertices move them."""
    both = crosses(triangles.faces, triangles.positions)
    areas = np.linalg.norm(both, axis=1)
    off = np.einsum("md,mkd->mk", both / areas[:, None], ways[triangles.faces])
    squares = (np.square(off).sum(axis=1) + np.square(off.sum(axis=1))) / 12
    return float(np.sqrt((squares * areas).sum() / areas.sum()))


def rounded(triangles: Triangles, config: RoundingConfig = CONFIG) -> Float64Array:
    return rounded_along(triangles, triangles.positions / STEP, config, 0)


@pytest.mark.parametrize("triangles", [ball(), sheet()], ids=["ball", "sheet"])
def test_the_surface_moves_half_as_far_as_by_the_nearest_points(triangles: Triangles) -> None:
    places = triangles.positions / STEP
    found, nearest = rounded(triangles), np.rint(places)
    assert np.array_equal(found, np.rint(found))
    assert np.abs(found - nearest).max() <= 1
    assert (found.min(axis=0) >= nearest.min(axis=0)).all()
    assert (found.max(axis=0) <= nearest.max(axis=0)).all()
    assert across(triangles, found - places) < 0.5 * across(triangles, nearest - places)


@pytest.mark.parametrize("triangles", [ball(), sheet()], ids=["ball", "sheet"])
def test_neighbors_make_up_for_each_other(triangles: Triangles) -> None:
    places = triangles.positions / STEP
    alone = rounded(triangles, replace(CONFIG, sweeps=1))
    assert across(triangles, rounded(triangles) - places) < across(triangles, alone - places)


def test_seams_stay_nearer_than_what_slides() -> None:
    turn = np.linalg.qr(np.array([[1.0, 0.3, 0.2], [0.4, 1.0, 0.6], [0.1, 0.7, 1.0]]))[0]
    on_seam = np.abs(ball().positions[:, 2]) < 1e-9
    turned = replace(ball(), positions=ball().positions @ turn.T)

    def off(config: RoundingConfig) -> float:
        ways = rounded(turned, config) - turned.positions / STEP
        return float(np.abs(ways[on_seam] @ turn[:, 2]).mean())

    assert off(CONFIG) < 0.7 * off(replace(CONFIG, seam=0.0))


def test_no_face_turns_over() -> None:
    fine = triangles_of(shapes.soup(shapes.sphere(40) * 0.3))
    found = rounded(fine)
    nearest = np.rint(fine.positions / STEP)
    before, after = crosses(fine.faces, nearest), crosses(fine.faces, found)
    assert ((before * after).sum(axis=1) >= 0).all()


def test_the_same_seed_rounds_the_same() -> None:
    assert np.array_equal(rounded(ball()), rounded(ball()))
