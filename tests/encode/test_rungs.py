from __future__ import annotations

import math
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, cast

import pytest

from nispcodec.encode.rungs import Rungs
from nispcodec.simplify.config import LadderConfig
from nispcodec.simplify.ladder import Candidate, Simplifier

EVERYTHING = 20_000


@dataclass
class PowerLaw:
    """In place of a simplifier: three bytes a face, a distance of 1 by the faces, and who asked."""

    config: LadderConfig = field(default_factory=LadderConfig)
    least: int = 0
    exact: int = EVERYTHING + 1
    asked: list[int] = field(default_factory=list)
    source: Any = field(default_factory=lambda: SimpleNamespace(triangles=range(EVERYTHING)))

    def balanced(self, faces: int) -> Candidate:
        self.asked.append(faces)
        made = SimpleNamespace(
            size=3 * faces,
            faces=faces,
            errors=SimpleNamespace(distance=self.distance(faces)),
        )
        return cast(Candidate, made)

    def distance(self, faces: int) -> float:
        if faces < self.least:
            return math.inf
        return 0.0 if faces >= self.exact else 1 / faces


@pytest.fixture
def law() -> PowerLaw:
    return PowerLaw()


@pytest.fixture
def rungs(law: PowerLaw) -> Rungs:
    return Rungs(
        cast(Simplifier, law), 1.8, bytes_per_face=2.0, slope=0.75, far_nearer=4.0, tries=4
    )


@pytest.mark.parametrize("faces", [200, 900, 5000, 15_000])
def test_between_two_rungs_the_bytes_are_those_of_the_power_law(rungs: Rungs, faces: int) -> None:
    found = rungs.bytes_at(1 / faces, 1000.0, 60_000.0)
    assert math.isclose(found, 3 * faces, rel_tol=0.03)


@pytest.mark.parametrize("faces", [200, 900, 5000, 15_000])
def test_as_many_faces_as_are_expected_to_be_that_near(rungs: Rungs, faces: int) -> None:
    rungs.bytes_at(1 / faces, 1000.0, 60_000.0)
    assert math.isclose(rungs.about(1 / faces).faces, faces, rel_tol=0.01)


@pytest.mark.parametrize("faces", [200, 900, 5000, 15_000])
@pytest.mark.parametrize("known", [150, 2000, EVERYTHING])
def test_a_distance_that_is_not_between_those_known_is_found_too(
    rungs: Rungs, known: int, faces: int
) -> None:
    rungs.at(known)
    assert math.isclose(rungs.about(1 / faces).faces, faces, rel_tol=0.01)


@pytest.mark.parametrize(("distance", "faces"), [(1e-9, EVERYTHING), (1.0, 150)])
def test_beyond_the_ladder_there_is_its_end(rungs: Rungs, distance: float, faces: int) -> None:
    rungs.at(2000)
    assert rungs.about(distance).faces == faces


def test_a_rung_that_is_exact_does_not_hide_those_before_it(law: PowerLaw, rungs: Rungs) -> None:
    law.exact = 4000
    rungs.at(2000)
    assert 1 / 3200 < rungs.about(1 / 3000).errors.distance < 1 / 2600


@pytest.mark.parametrize("start", [150.0, 3000.0, 30_000.0])
def test_the_least_cost_is_found_from_either_side(rungs: Rungs, start: float) -> None:
    found = rungs.cheapest(lambda made: (0.0, abs(math.log(made.faces / 2000))), start)
    assert 2000 / 1.8**0.5 <= found.faces <= 2000 * 1.8**0.5


def test_what_is_clearly_too_large_takes_one_candidate(law: PowerLaw, rungs: Rungs) -> None:
    assert rungs.bytes_at(1e-6, 1000.0, 2000.0) > 2000
    assert len(law.asked) == 1


def test_no_more_candidates_than_tries(law: PowerLaw, rungs: Rungs) -> None:
    for distance in (1e-2, 1e-3, 1e-4, 1e-9, 10.0):
        law.asked.clear()
        assert rungs.bytes_at(distance, 600.0, 1e9) > 0
        assert len(law.asked) <= 4


def test_each_rung_is_made_once(law: PowerLaw, rungs: Rungs) -> None:
    rungs.bytes_at(1 / 2000, 3000.0, 9000.0)
    rising = list(rungs.rising(math.inf))
    assert [each.faces for each in rising] == sorted({*law.asked})
    assert len(law.asked) == len(rising)
    assert rising[-1].faces == EVERYTHING


def test_rising_ends_with_the_first_of_so_many_bytes(rungs: Rungs) -> None:
    sizes = [each.size for each in rungs.rising(4000.0)]
    assert sizes[-1] >= 4000 > sizes[-2]


def test_candidates_of_which_nothing_is_left_are_no_trouble(law: PowerLaw, rungs: Rungs) -> None:
    law.least = 1000
    assert 900 < rungs.bytes_at(1 / 2000, 600.0, 900.0) < math.inf


def test_to_a_distance_none_is_made_that_is_surely_too_far_or_too_large(
    law: PowerLaw, rungs: Rungs
) -> None:
    rungs.at(875)
    found = [each.faces for each in rungs.rising(7500.0, 1 / 1500)]
    assert found == [875, 1575]
