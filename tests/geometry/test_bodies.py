"""Meshes as people have them: the inside is that of the shape before it was broken."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable

import igl
import numpy as np
import pytest

from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.geometry.bodies import Bodies, find_bodies
from nispcodec.geometry.config import SolidConfig
from nispcodec.geometry.distance import DistanceField
from nispcodec.geometry.solid import Solid, build_solid
from nispcodec.geometry.welding import welded
from tests.geometry.shapes import cube, grid, hemisphere, soup, sphere

HALF = SolidConfig.half_thickness
NOTHING = np.zeros((0, 3, 3))
UP = np.array([0.0, 0.0, 1.0])
BALL = 0.6 * sphere()
BOX = cube((-0.5,) * 3, 1.0)
GROUND = grid() - 0.65 * UP


def solid_of(corners: Float64Array) -> Solid:
    return build_solid(corners, welded(soup(corners)))


def bodies_of(corners: Float64Array) -> Bodies:
    return find_bodies(corners, welded(soup(corners)).positions)


def flipped(corners: Float64Array, chosen: BoolArray) -> Float64Array:
    return np.where(chosen[:, None, None], corners[:, ::-1], corners)


def some(corners: Float64Array, share: float) -> Float64Array:
    return flipped(corners, np.random.default_rng(0).random(len(corners)) < share)


def cap(corners: Float64Array) -> Float64Array:
    return flipped(corners, corners[:, :, 2].mean(axis=1) > 0.3)


def both_ways(corners: Float64Array) -> Float64Array:
    return np.concatenate([corners, corners[:, ::-1]])


def mixed(corners: Float64Array) -> Float64Array:
    """Every face both ways round, in any order."""
    doubled = both_ways(corners)
    return doubled[np.random.default_rng(0).permutation(len(doubled))]


def rounded_both_ways(corners: Float64Array) -> Float64Array:
    """Every face both ways round, one copy as single precision rounds it."""
    return np.concatenate([corners, corners[:, ::-1].astype(np.float32)])


def partly_twice(corners: Float64Array) -> Float64Array:
    return np.concatenate([corners, corners[: len(corners) // 3]])


def partly_both_ways(corners: Float64Array) -> Float64Array:
    return np.concatenate([corners, corners[: len(corners) // 3, ::-1]])


def cracked(corners: Float64Array, by: float) -> Float64Array:
    """As rounding opens a seam: on one half of space every corner is a little off."""
    half = corners.mean(axis=1)[:, 0] > 0
    noise = np.random.default_rng(0).uniform(-by, by, corners.shape)
    return corners + noise * half[:, None, None] * (np.abs(corners[..., :1]) < 1e-9)


def parted(corners: Float64Array, gap: float) -> Float64Array:
    """The lower half reversed, and so far below the upper one."""
    lower = corners[:, :, 2].mean(axis=1) < 0
    return flipped(corners, lower) - gap * lower[:, None, None] * UP


def exploded(corners: Float64Array, gap: float) -> Float64Array:
    """A third of the faces reversed, and every face a little off all others."""
    noise = np.random.default_rng(1).uniform(-gap, gap, (len(corners), 1, 3))
    return some(corners, 0.3) + noise


BARS = np.concatenate([BOX * [1.6, 0.4, 0.4], BOX * [0.4, 1.4, 0.5]])
CHAIN = np.concatenate([0.5 * BALL + [x, 0, 0] for x in (-0.5, -0.05, 0.45)])

# Name -> the closed bodies, what is done to them, and what has no inside.
BROKEN: dict[str, tuple[Float64Array, Callable[[Float64Array], Float64Array], Float64Array]] = {
    "whole": (BALL, lambda c: c, NOTHING),
    "a wall reversed": (BOX, lambda c: flipped(c, np.arange(12) < 2), NOTHING),
    "a cap reversed": (BALL, cap, NOTHING),
    "a fifth reversed": (BALL, lambda c: some(c, 0.2), NOTHING),
    "half reversed": (BALL, lambda c: some(c, 0.5), NOTHING),
    "most reversed": (BALL, lambda c: some(c, 0.8), NOTHING),
    "both ways": (BALL, both_ways, NOTHING),
    "both ways in any order": (BALL, mixed, NOTHING),
    "both ways, one rounded": (BALL, rounded_both_ways, NOTHING),
    "both ways, one rounded, over ground": (BALL, rounded_both_ways, GROUND),
    "partly both ways": (BALL, partly_both_ways, NOTHING),
    "partly twice": (BALL, partly_twice, NOTHING),
    "twice": (BALL, lambda c: np.concatenate([c, c]), NOTHING),
    "cap, over ground": (BALL, cap, GROUND),
    "both ways, over ground": (BALL, both_ways, GROUND),
    "cracked in double precision": (BALL, lambda c: cracked(c, 2e-16), GROUND),
    "cracked in single precision": (BALL, lambda c: cracked(c, 1e-7), GROUND),
    "cracked, both ways": (BALL, lambda c: both_ways(cracked(c, 1e-7)), GROUND),
    "cracked, reversed": (BALL, lambda c: some(cracked(c, 1e-7), 0.2), GROUND),
    "over two grounds": (BALL, lambda c: c, np.concatenate([GROUND, GROUND - 0.1 * UP])),
    "over a ground that faces down": (BALL, lambda c: c, GROUND[:, ::-1]),
    "on a corner of the ground": (BALL, lambda c: c, 0.05 * UP + GROUND),
    "two that share a corner": (
        np.concatenate([cube((-0.5,) * 3, 0.5), cube((0, 0, 0), 0.5)]),
        lambda c: flipped(c, np.arange(24) >= 22),
        NOTHING,
    ),
    "two that share an edge": (
        np.concatenate([cube((-0.5, -0.5, -0.2), 0.5), cube((0, 0, -0.2), 0.5)]),
        lambda c: flipped(c, np.arange(24) < 2),
        NOTHING,
    ),
    "one inside out that meets another": (
        np.concatenate([cube((-0.6, -0.3, -0.3), 0.7), cube((-0.1, -0.2, -0.2), 0.6)]),
        lambda c: flipped(c, np.arange(24) >= 12),
        NOTHING,
    ),
    "crossing bars of two triangles a wall, one inside out": (
        BARS,
        lambda c: flipped(c, np.arange(24) >= 12),
        NOTHING,
    ),
    "crossing bars, both inside out": (BARS, lambda c: c[:, ::-1], NOTHING),
    "a chain, inside out from the second link on": (
        CHAIN,
        lambda c: flipped(c, np.arange(len(c)) >= len(BALL)),
        NOTHING,
    ),
    "halves apart by rounding, one reversed": (BALL, lambda c: parted(c, 1e-5), NOTHING),
    "halves apart by 12 bits, one reversed": (BALL, lambda c: parted(c, 3e-4), NOTHING),
    "halves apart, one reversed, over ground": (BALL, lambda c: parted(c, 1e-4), GROUND),
    "exploded, a third reversed": (BALL, lambda c: exploded(c, 1e-5), NOTHING),
    "a ball of which the lower half is reversed, in a box": (
        np.concatenate([BOX, 0.3 * sphere() + [0.5, 0, 0]]),
        lambda c: flipped(c, (np.arange(len(c)) >= 12) & (c[:, :, 2].mean(axis=1) < 0)),
        NOTHING,
    ),
}


def truth(corners: Float64Array, points: Float64Array) -> BoolArray:
    """By parity along a ray from each point, of each closed body by itself."""
    inside = np.zeros(len(points), dtype=bool)
    names = welded(soup(corners))
    body = find_bodies(corners, names.positions).body
    for name in np.unique(body):
        triangles = corners[body == name]
        vertices = np.ascontiguousarray(triangles.reshape(-1, 3))
        faces = np.arange(len(vertices)).reshape(-1, 3)
        tree = igl.AABB()
        tree.init(vertices, faces)
        ways = np.tile([0.3141, 0.5772, 0.7539], (len(points), 1))
        hits = tree.intersect_ray(vertices, faces, points, ways)
        inside |= np.array([len(each) % 2 == 1 for each in hits])
    return inside


@pytest.mark.parametrize("name", BROKEN)
def test_signs_are_those_of_the_shape_before_it_was_broken(name: str) -> None:
    closed, breaking, sheets = BROKEN[name]
    points = np.random.default_rng(1).uniform(-1, 1, (20_000, 3))
    corners = np.concatenate([breaking(closed), sheets])
    field = DistanceField(solid_of(corners))
    inside, found = truth(closed, points), field.closest(points)
    off_sheets = ~found.sheet
    assert off_sheets.mean() > 0.4
    assert np.array_equal((found.sdf < 0)[off_sheets], inside[off_sheets])
    assert not inside[found.sheet].any()
    open_share = 0.0 if not len(sheets) else field.solid.open_surface_share
    assert field.solid.open_surface_share == pytest.approx(open_share, abs=1e-3)


def stacked(count: int, gap: float = 0.1) -> Float64Array:
    layers = [grid() + gap * (i - count / 2) * UP for i in range(count)]
    return 0.6 * np.concatenate(layers)


@pytest.mark.parametrize(
    "sheets",
    [
        *(stacked(count) for count in (1, 2, 3, 5)),
        flipped(stacked(2), np.arange(144) < 72),
        flipped(stacked(2), np.arange(144) >= 72),
        flipped(stacked(4), np.arange(288) // 72 % 2 == 0),
        np.concatenate([0.6 * hemisphere(), 0.55 * hemisphere(), 0.5 * hemisphere()]),
        both_ways(stacked(3)),
        some(stacked(2), 0.2),
    ],
    ids=["1", "2", "3", "5", "apart", "towards", "4 by turns", "domes", "both ways", "reversed"],
)
def test_between_sheets_nothing_is_inside(sheets: Float64Array) -> None:
    solid = solid_of(sheets)
    assert solid.open_surface_share == pytest.approx(1, abs=1e-3)
    points = np.random.default_rng(1).uniform(-1, 1, (20_000, 3))
    found = DistanceField(solid).closest(points)
    away = igl.point_mesh_squared_distance(
        points, sheets.reshape(-1, 3), np.arange(sheets.shape[0] * 3).reshape(-1, 3)
    )[0]
    assert found.sdf == pytest.approx(np.sqrt(away) - HALF, abs=1e-5)


def test_a_cavity_stays_one() -> None:
    hollow = np.concatenate([BALL, 0.5 * BALL[:, ::-1]])
    for corners in (hollow, some(hollow, 0.2), hollow[:, ::-1]):
        field = DistanceField(solid_of(corners))
        assert field.closest(np.array([[0.01, 0.02, 0.03], [0.45, 0, 0]])).sdf[0] > 0.2
        assert field.closest(np.array([[0.01, 0.02, 0.03], [0.45, 0, 0]])).sdf[1] < -0.1


def test_what_is_in_order_is_left_alone() -> None:
    for corners in (BALL, BOX, GROUND, np.concatenate([BALL, GROUND])):
        found = bodies_of(corners)
        assert not found.turned.any()
        assert not found.spare.any()
        assert not found.unclear.any()
        assert found.welded == 0
        assert solid_of(corners).warnings == ()


@pytest.mark.parametrize(("gap", "told"), [(2.4e-16, False), (6e-8, False), (5e-7, True)])
def test_gaps_of_rounding_are_closed_without_a_word(gap: float, told: bool) -> None:
    corners = BALL.copy()
    corners[:6] += gap
    solid = solid_of(corners)
    assert solid.open_surface_share == 0
    assert any("closed seams" in each for each in solid.warnings) == told


def test_bodies_are_joined_by_edges_and_not_by_a_corner() -> None:
    assert bodies_of(np.concatenate([BOX, BOX + 1.0])).body.max() == 1
    assert bodies_of(np.concatenate([BOX, BOX + np.array([1.0, 1.0, 0.0])])).body.max() == 0


def test_a_rim_is_where_no_other_side_is() -> None:
    assert not len(bodies_of(BOX).rim)
    lids = np.isin(np.arange(12) // 2, (4, 5))
    for corners in (BOX[~lids], some(BOX[~lids], 0.3), both_ways(BOX[~lids])):
        found = bodies_of(corners)
        assert len(found.rim) == 8
        assert np.bincount(found.loops).tolist() == [4, 4]
        assert not found.spare[found.rim // 3].any()
        assert set(found.body) == {0}


def test_of_faces_both_ways_round_the_one_that_faces_outwards_stays() -> None:
    found = bodies_of(np.concatenate([BOX[:, ::-1], BOX]))
    assert found.spare.tolist() == [True] * 12 + [False] * 12
    assert not found.turned.any()
    assert found.two_sided.all()


def test_warnings_say_what_was_done_and_to_how_much() -> None:
    one_wall = solid_of(flipped(BOX, np.arange(12) < 2)).warnings
    assert len(one_wall) == 1
    assert "turned" in one_wall[0]
    assert "16.67% of the area" in one_wall[0]
    (doubled,) = solid_of(both_ways(BOX)).warnings
    assert "both ways round: 50.00%" in doubled
    assert any("seams" in each for each in solid_of(cracked(BALL, 1e-7)).warnings)
    assert any("could not tell" in each for each in solid_of(some(GROUND, 0.5)).warnings)
    assert solid_of(both_ways(GROUND)).warnings == ()


def test_beside_a_far_outlier_memory_goes_with_the_faces() -> None:
    generator = np.random.default_rng(0)
    crowd = 1e-9 * generator.uniform(-1, 1, (1500, 3, 3))
    outlier = np.array([[[1.0, 0, 0], [1, 1e-9, 0], [1, 0, 1e-9]]])
    corners = np.concatenate([crowd, outlier])
    tracemalloc.start()
    found = bodies_of(corners)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found.body) == len(corners)
    assert peak < 40e6
