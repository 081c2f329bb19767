"""Candidates from few faces to all."""

from __future__ import annotations

import numpy as np
import pytest

from nispcodec.format.mesh import encode
from nispcodec.simplify.errors import Counted
from nispcodec.simplify.ladder import Candidate, Simplifier
from nispcodec.simplify.triangles import Triangles
from tests.geometry import shapes
from tests.simplify.meshes import (
    SMALL,
    ball,
    bare_ball,
    coded,
    half_dressed_ball,
    sheet,
    simplifier,
    triangles_of,
)


def rungs_of(made: Simplifier) -> list[Candidate]:
    """From few faces to all, each about twice as many."""
    everything = len(made.source.triangles)
    fewest = min(made.config.fewest, everything)
    counts = np.geomspace(fewest, everything, 2 + round(np.log2(everything / fewest)))
    return [made.balanced(round(float(count))) for count in counts]


@pytest.mark.parametrize("triangles", [ball(), bare_ball(), half_dressed_ball(), sheet()])
def test_candidates_go_from_few_faces_to_all(triangles: Triangles) -> None:
    rungs = rungs_of(simplifier(triangles))
    faces = [rung.faces for rung in rungs]
    assert len(rungs) >= 3
    assert faces == sorted(faces)
    assert faces[0] < 60
    assert faces[-1] == len(triangles)
    sizes, distances = [rung.size for rung in rungs], [rung.errors.distance for rung in rungs]
    assert sizes == sorted(sizes)
    assert distances == sorted(distances, reverse=True)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_mesh_of_few_faces_has_candidates(count: int) -> None:
    few = triangles_of(shapes.soup(shapes.cube((-0.5, -0.5, -0.5), 1.0)[:count]))
    assert [rung.faces for rung in rungs_of(simplifier(few))][-1] == count


def test_faces_that_are_not_kept_are_not_missed_but_may_be_found() -> None:
    given = ball()
    above = given.corners[..., 2].mean(axis=1) > 0
    half = Simplifier.of(given, coded, SMALL, counted=Counted.of(above)).candidate(
        len(given), 14, 14
    )
    assert half.faces == above.sum()
    assert half.errors.distance < 1e-3


def test_finer_errors_want_more_bits() -> None:
    made = simplifier(ball(4))
    assert made.bits_for(1e-4) == made.bits_for(1e-3) + 3
    assert made.uv_bits_for(1e-3) < made.uv_bits_for(1e-4)
    assert simplifier(bare_ball(4)).uv_bits_for(1e-3) == 1


def test_candidates_hold_no_hidden_faces() -> None:
    inner = shapes.sphere(5) * 0.4
    both = triangles_of(shapes.soup(np.concatenate([shapes.sphere(8), inner])))
    kept = np.arange(len(both)) < len(both) - len(inner)
    alone = simplifier(both.only(kept)).candidate(60, 10, 10)
    found = Simplifier.of(both, coded, SMALL, 0, Counted.of(kept)).candidate(60, 10, 10)
    assert encode(found.parts) == encode(alone.parts)
