"""Mirror symmetry: which axes count, and that asking changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from tests.geometry.shapes import CUBE_CORNERS, CUBE_FACES, cube, hemisphere, soup
from tests.samplers import analysis_of, sampler_of


def of(triangles: np.ndarray) -> int:
    return analysis_of(soup(triangles)).symmetry.sdf


def test_a_box_is_symmetric_in_three_axes_wherever_it_stands() -> None:
    box = (CUBE_CORNERS * [1, 2, 3] + [7, -5, 0.3])[CUBE_FACES]
    assert of(box) == 0b111


def with_bump(axis: int) -> np.ndarray:
    """A small cube inside the bounding box that two plates set, centered in the other two axes."""
    plates = [cube((0, 0, 0), 1.0) * [1, 1, 0.1] + [0, 0, at] for at in (0, 0.9)]
    upright = np.concatenate([*plates, cube((0.46, 0.46, 0.1), 0.08)])
    return np.roll(upright, axis - 2, axis=2)


@pytest.mark.parametrize("axis", range(3))
def test_a_bump_on_one_side_is_told_from_the_other(axis: int) -> None:
    assert of(with_bump(axis)) == 0b111 | 0b1000 << axis


@pytest.mark.parametrize("axis", range(3))
def test_where_a_ghost_of_the_bump_would_be_there_are_samples(axis: int) -> None:
    sampler = sampler_of(soup(with_bump(axis)), seed=0)
    (found,) = sampler.asymmetric(20_000, 0.01)
    bump = np.zeros(3)
    bump[axis] = (0.5 - 0.14) / np.linalg.norm([0.5, 0.5, 0.5])
    beside_the_bump = np.linalg.norm(np.abs(found.points) - bump, axis=1) < 0.15
    ghost = (found.points[:, axis] > 0) & beside_the_bump
    assert beside_the_bump.mean() > 0.9
    assert ghost.sum() > 50
    assert (found.sdf[ghost] > 0).mean() > 0.6


def test_a_symmetric_asset_needs_no_such_samples() -> None:
    assert sampler_of(soup(cube((0, 0, 0), 1.0)), seed=0).asymmetric(1000, 0.01) == []


def test_a_sheet_counts_like_a_body() -> None:
    assert of(hemisphere()) == 0b011
