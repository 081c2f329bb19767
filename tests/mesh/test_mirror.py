"""Mirror symmetry: which axes count, and that asking changes nothing."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.mesh.mirror import Mirrors, mirrors
from nispcodec.mesh.samples import Sampler
from tests.mesh.shapes import CUBE_CORNERS, CUBE_FACES, cube, hemisphere, soup


def of(triangles: np.ndarray) -> int:
    return mirrors(Sampler(soup(triangles), seed=0)).sdf


def test_a_box_is_symmetric_in_three_axes_wherever_it_stands() -> None:
    box = (CUBE_CORNERS * [1, 2, 3] + [7, -5, 0.3])[CUBE_FACES]
    assert of(box) == 0b111


@pytest.mark.parametrize("axis", range(3))
def test_a_bump_on_one_side_is_told_from_the_other(axis: int) -> None:
    """A small cube inside the bounding box that two plates set, centred in the other two axes."""
    plates = [cube((0, 0, 0), 1.0) * [1, 1, 0.1] + [0, 0, at] for at in (0, 0.9)]
    bump = cube((0.46, 0.46, 0.1), 0.08)
    upright = np.concatenate([*plates, bump])
    assert of(np.roll(upright, axis - 2, axis=2)) == 0b111 | 0b1000 << axis


def test_a_sheet_counts_like_a_body() -> None:
    assert of(hemisphere()) == 0b011


def test_asking_leaves_the_samples_as_they_are() -> None:
    asked, other = Sampler(soup(cube((0, 0, 0), 1.0)), 3), Sampler(soup(cube((0, 0, 0), 1.0)), 3)
    assert mirrors(asked) == mirrors(asked)
    assert np.array_equal(asked.near(50, 0.01).points, other.near(50, 0.01).points)
