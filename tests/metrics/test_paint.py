from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from nispcodec.core.asset import Texture
from nispcodec.metrics.color import color_psnr
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.paint import Paint
from nispcodec.metrics.surface import Surface
from tests.metrics.shapes import plane

PLANE = plane()


def test_the_same_surface_has_the_same_colors() -> None:
    surface = Surface(PLANE, PLANE.positions)
    points = surface.sample(500, np.random.default_rng(0))
    assert not Paint.of(PLANE).misses(surface, surface, Matches(points, points)).any()


def test_misses_are_those_of_the_metric_of_colors() -> None:
    moved = replace(PLANE, uvs=PLANE.uvs + 0.21)
    first, second = Surface(PLANE, PLANE.positions), Surface(moved, moved.positions)
    points = first.sample(500, np.random.default_rng(0))
    matches = Matches(points, points)
    misses = Paint.of(PLANE).misses(first, second, matches)
    expected = color_psnr(first, second, [matches])
    assert math.isclose(-10 * math.log10(misses.mean()), expected, abs_tol=0.01)


def test_a_material_whose_image_is_broken_shows_its_factor() -> None:
    broken = replace(
        PLANE, textures=tuple(Texture("a.png", b"", "image/png") for _ in PLANE.textures)
    )
    surface = Surface(broken, broken.positions)
    points = surface.sample(10, np.random.default_rng(0))
    assert not Paint.of(broken).misses(surface, surface, Matches(points, points)).any()
