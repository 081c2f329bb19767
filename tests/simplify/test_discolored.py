"""Places whose color is lost are found, and keep their vertices."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from nispcodec.core.arrays import BoolArray
from nispcodec.core.asset import Material
from nispcodec.metrics.paint import Paint
from nispcodec.simplify.config import DiscoloredConfig
from nispcodec.simplify.discolored import Discolored
from nispcodec.simplify.errors import Counted, Original
from nispcodec.simplify.ladder import Simplifier
from nispcodec.simplify.source import Source
from nispcodec.simplify.triangles import Triangles, joined
from tests.geometry import shapes
from tests.simplify.meshes import SMALL, ball, coded, sheet, triangles_of

PAINT = Paint((Material(), Material(base_color=(0.2, 0.0, 0.0, 1.0))), {})
CONFIG = DiscoloredConfig()


def painted(triangles: Triangles, red: BoolArray) -> Triangles:
    return replace(triangles, materials=red.astype(np.int32))


def original(triangles: Triangles, paint: Paint | None = PAINT) -> Original:
    return Original.of(triangles, Source(triangles).tree, 8000, 0, paint=paint)


def label() -> Triangles:
    """A wavy sheet, and a red label with a low rim in a shallow recess of its flat middle."""
    wavy, plate = shapes.grid(40), shapes.grid(8) * [0.21, 0.11, 1.0]
    x, y = np.abs(wavy[..., 0]), np.abs(wavy[..., 1])
    waves = 0.1 * np.sin(9 * wavy[..., 0]) * np.sin(9 * wavy[..., 1])
    wavy[..., 2] = waves * np.clip(4 * (x - 0.3), 0, 1) - 0.006 * ((x < 0.24) & (y < 0.14))
    low = np.abs(plate[..., :2] / [0.21, 0.11]).max(axis=2) > 0.99
    plate[..., 2] = np.where(low, -0.005, -0.001)
    both = triangles_of(shapes.soup(np.concatenate([wavy, plate])))
    return painted(both, np.arange(len(both)) >= len(wavy))


def test_the_same_colors_are_none() -> None:
    given = painted(ball(), ball().corners[..., 0].mean(axis=1) > 0)
    found = Discolored.of(original(given), given.mesh(), CONFIG)
    assert found.share == 0
    assert not len(found.corners)


def test_a_spot_of_another_color_is_found_with_what_is_beside_it() -> None:
    given = sheet(30)
    centers = given.corners.mean(axis=1)[:, :2]
    spot = np.linalg.norm(centers - [0.3, -0.2], axis=1) < 0.15
    found = Discolored.of(original(painted(given, spot)), given.mesh(), CONFIG)
    assert found.share == pytest.approx(np.pi * 0.15**2 / 4, rel=0.35)
    assert np.abs(found.corners[:, :2] - [0.3, -0.2]).max() < 0.3
    assert len(found.corners) > spot.sum() / 2


def test_vertices_of_walls_that_nobody_sees_count_as_beside() -> None:
    given = sheet(30)
    centers = given.corners.mean(axis=1)
    spot = np.linalg.norm(centers[:, :2] - [0.3, -0.2], axis=1) < 0.15
    wall = (centers[~spot] - [0.0, 0.0, 0.01])[:1]
    hidden = triangles_of(shapes.soup(wall[:, None] + 0.001 * np.eye(3)))
    both = painted(joined(given, hidden), np.append(spot, False))
    held = Counted.of(np.arange(len(both)) < len(given))
    known = Original.of(both, Source(both).tree, 8000, 0, held, PAINT)
    points = np.linalg.norm(known.points.positions - wall[0], axis=1) < 0.05
    found = Discolored(known, points, replace(CONFIG, beside=0.05))
    apart = np.abs(found.corners[:, None] - hidden.corners[0]).max(axis=2)
    assert (apart.min(axis=0) < 1e-12).all()


def test_a_border_that_is_a_little_off_is_none() -> None:
    given = sheet(30)
    given = painted(given, given.corners[..., 0].mean(axis=1) > 0)
    moved = replace(given, positions=given.positions + np.array([0.002, 0, 0]))
    assert not Discolored.of(original(given), moved.mesh(), CONFIG).share


def test_without_colors_there_is_none() -> None:
    given = painted(ball(), np.ones(len(ball()), np.bool_))
    assert not Discolored.of(original(given, None), ball().mesh(), CONFIG).share


def lost(made: Simplifier, faces: int) -> float:
    decoded = made.copies.scene(made.fitted(faces))
    return Discolored.of(original(label()), decoded, CONFIG).share


def test_a_label_in_a_recess_is_not_lost_where_few_vertices_hold_it() -> None:
    few, many = (
        replace(SMALL, samples=8000, discolored=replace(CONFIG, most_kept=share))
        for share in (0.01, 0.5)
    )
    blind = Simplifier.of(label(), coded, many)
    heedless = Simplifier.of(label(), coded, few, paint=PAINT)
    heedful = Simplifier.of(label(), coded, many, paint=PAINT)
    assert lost(blind, 500) == lost(heedless, 500) > 0.01
    assert lost(heedful, 500) < 0.2 * lost(blind, 500)
