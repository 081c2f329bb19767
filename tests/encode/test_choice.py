"""Which form an asset gets, with a form whose sizes are told and nothing fitted."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from nispcodec import EncodeConfig
from nispcodec.core.document import Document, Field
from nispcodec.core.errors import FitError, TargetSizeError
from nispcodec.core.mesh_part import MeshPart
from nispcodec.core.network import NetworkSpec
from nispcodec.encode.bodies import Sorted
from nispcodec.encode.choice import Choice, Chosen
from nispcodec.encode.config import FormConfig, Tuning
from nispcodec.encode.mesh_form import coded_bytes
from nispcodec.format import own_bytes, pack
from nispcodec.metrics.faulty_points import FaultyPoints
from nispcodec.simplify.errors import Errors
from tests import tiny
from tests.infer.parts import cube, part_of

PART = part_of(cube())
TUNING = Tuning()
FIELD = tiny.document(sdf=tiny.random_network(NetworkSpec((24, 24), 1)))
SIZE = own_bytes(pack(FIELD))
EXACT = Errors(0.0, 0.0, 0.0, 0.0)
OFF = Errors(0.01, 0.02, 0.01, 0.005)
FAR_OFF = replace(OFF, distance=10.0, color=1.0)


class Told:
    """In place of a MeshForm: what it says, and what it was asked."""

    made_errors = replace(EXACT, distance=3.5e-4)

    def __init__(self, estimate: float = 0.0, least_cost: float = 100.0, **found: Any) -> None:
        self.bytes, self.found, self.least_cost = estimate, found, least_cost
        self.asked: list[tuple[Any, ...]] = []

    def estimate(self, distance: float, few: float, many: float) -> float:
        return self.bytes

    @property
    def made(self) -> list[Any]:
        return [SimpleNamespace(size=self.bytes, errors=self.made_errors)]

    def cheapest(self) -> Any:
        return self.found.get("cheapest", self.made[0])

    others, sheets = 0.1, False

    def sorted_bodies(self) -> Sorted:
        """Half of the faces dense, and all but the others' share of the bytes."""
        dense, others = np.array([True, False]), self.others * self.bytes
        return Sorted(dense, ~dense, self.bytes - others, others, 3.5e-4, self.sheets)

    def __getattr__(self, name: str) -> Any:
        def answer(*limits: float, stage: str = "surface") -> Any:
            self.asked.append((name, *limits, *([0.0] * (2 - len(limits)))))
            return self.found.get(name)

        return answer


def candidate(errors: Errors = EXACT) -> Any:
    return SimpleNamespace(parts=(PART,), errors=errors, size=coded_bytes((PART,)))


def choice(form: Any, halves: Any = None, tuning: Tuning = TUNING, **options: Any) -> Choice:
    config = EncodeConfig(**options)
    return Choice(form, config, tuning, lambda _: halves, tried, as_mesh, as_chosen)


def as_chosen(chosen: Chosen) -> Document:
    return chosen.document


def tried() -> Field:
    assert FIELD.field is not None
    return FIELD.field


def as_mesh(field: Field | None, parts: tuple[MeshPart, ...]) -> Document:
    return replace(FIELD, field=field, meshes=parts)


@pytest.mark.parametrize(
    ("estimate", "wanted"), [(100.0, False), (499.0, False), (501.0, True), (5000.0, True)]
)
def test_networks_are_fitted_unless_triangles_are_surely_smaller(
    estimate: float, wanted: bool
) -> None:
    form = Told(estimate, errors=EXACT)
    form.made_errors = FAR_OFF
    assert choice(form).wants_field(1000.0, 1e-3) is wanted


def test_of_fine_detail_less_is_left_to_the_fit() -> None:
    fine = 1.1 * Tuning().training.sizing.fine
    forms = [Told(each, errors=EXACT) for each in (790, 810)]
    for form in forms:
        form.made_errors = FAR_OFF
    assert [choice(form).wants_field(1000.0, fine) for form in forms] == [False, True]


@pytest.mark.parametrize(("estimate", "looks"), [(600.0, True), (1500.0, False)])
def test_triangles_that_a_short_fit_loses_to_are_taken_without_a_whole_one(
    estimate: float, looks: bool
) -> None:
    near = candidate(replace(OFF, distance=0.75 * OFF.distance))
    form = Told(estimate, errors=OFF, about=near, nearer=near)
    found = choice(form)
    assert found.wants_field(1000.0, 1e-3) is not looks
    if looks:
        assert ("about", 0.75 * OFF.distance, 0.0) in form.asked
        assert form.asked[-1] == ("nearer", near, 0.75 * OFF.distance, max(SIZE, 1000.0))
        chosen = found.triangles()
        assert (chosen.document.meshes, chosen.other_bytes) == ((PART,), SIZE)


def test_networks_that_cost_less_than_all_triangles_that_were_made_are_set_against_no_more() -> (
    None
):
    form = Told(600.0, errors=EXACT)
    form.made_errors = FAR_OFF
    found = choice(form)
    assert found.wants_field(1000.0, 1e-3)
    assert found.after_fit(FIELD, EXACT).document is FIELD
    assert [name for name, *_ in form.asked] == ["errors"]


def test_who_learns_shortly_makes_no_trial() -> None:
    form = Told(600.0, errors=OFF, about=candidate())
    assert choice(form, preset="fast").wants_field(1000.0, 1e-3)
    assert form.asked == []


def halves(networks: float, errors: Errors = EXACT) -> Any:
    """Two of an asset, whose networks are foreseen to take so many bytes, at 3.5e-4.

    After a trial their surface has these errors.
    """
    field = SimpleNamespace(foreseen=(networks, 1e-3), trial=tried)
    dense = SimpleNamespace(errors=lambda document, most_faces, stage: errors)
    return SimpleNamespace(field=field, dense=dense, share=0.5)


@pytest.mark.parametrize(("networks", "taken"), [(4000.0, True), (9000.0, False)])
def test_an_asset_is_split_where_both_halves_together_are_small(
    networks: float, taken: bool
) -> None:
    found = choice(Told(10_000.0), halves(networks))
    assert found.wants_field(30_000.0, 1e-3) is False
    assert (found.split is not None) is taken


def test_an_asset_is_not_split_where_a_short_fit_shows_no_gain() -> None:
    near = candidate()
    form = Told(10_000.0, about=near)
    found = choice(form, halves(4000.0, FAR_OFF))
    assert found.wants_field(30_000.0, 1e-3) is False
    assert found.split is None
    assert ("about", TUNING.forms.fitted * 1e-3, 0.0) in form.asked
    assert found.triangles().document.meshes == (PART,)


def test_halves_are_set_against_the_cheapest_triangles_there_are() -> None:
    cheap = SimpleNamespace(size=500.0, errors=EXACT)
    found = choice(Told(10_000.0, about=candidate(), cheapest=cheap), halves(4000.0))
    assert found.wants_field(30_000.0, 1e-3) is False
    assert found.split is None


@pytest.mark.parametrize(("others", "sheets"), [(0.04, False), (0.04, True), (0.06, False)])
def test_few_small_bodies_go_with_the_networks_unless_they_are_sheets(
    others: float, sheets: bool
) -> None:
    form = Told(10_000.0, errors=EXACT)
    form.made_errors, form.others, form.sheets = FAR_OFF, others, sheets
    found = choice(form, halves(4000.0))
    found.wants_field(30_000.0, 1e-3)
    assert (found.split is None) is (others < 0.05 and not sheets)


def test_halves_that_cannot_be_small_are_not_made() -> None:
    found = choice(Told(3500.0), halves(1.0))
    found.wants_field(30_000.0, 1e-3)
    assert found.split is None


@pytest.mark.parametrize(
    "options",
    [
        {"geometry": "field"},
        {"preset": "paper"},
        {"prune": "smallest"},
        {"target_error": 1e-3},
    ],
)
def test_who_asks_for_networks_gets_them(options: dict[str, Any]) -> None:
    assert choice(Told(1.0), **options).wants_field(1000.0, 1e-3)


def test_triangles_that_are_smaller_and_no_worse_are_taken() -> None:
    chosen = choice(Told(10.0, about=candidate())).after_fit(FIELD, OFF)
    assert chosen.document.field is None
    assert chosen.document.meshes == (PART,)
    assert (chosen.errors, chosen.other_bytes) == (EXACT, SIZE)


def test_triangles_are_set_against_a_field_at_its_own_distance() -> None:
    form = Told(10.0, about=candidate())
    choice(form).after_fit(FIELD, OFF)
    assert form.asked == [("about", OFF.distance, 0.0)]


LOST = FaultyPoints(1000, np.zeros((50, 3)), np.zeros(50, np.int32))


@pytest.mark.parametrize("errors", [replace(OFF, color=0.05), replace(OFF, lost=LOST)])
def test_wrong_colors_and_lost_surface_of_networks_are_worth_bytes(errors: Errors) -> None:
    same = replace(EXACT, distance=OFF.distance)
    larger = SimpleNamespace(parts=(PART,) * 38, errors=same, size=1.1 * SIZE)
    assert 1 < own_bytes(pack(as_mesh(None, larger.parts))) / SIZE < TUNING.forms.worth(errors)
    chosen = choice(Told(SIZE, about=larger)).after_fit(FIELD, errors)
    assert len(chosen.document.meshes) == 38
    assert choice(Told(SIZE, about=larger)).after_fit(FIELD, OFF).document is FIELD


def test_the_best_preset_takes_more_bytes_for_triangles_that_are_near() -> None:
    budget = Tuning().training.budgets["best"]
    assert budget.worth > 1
    for size, fitted in ((0.9 * budget.worth * 1000, False), (1.1 * budget.worth * 1000, True)):
        form = Told(size, best=candidate())
        asked = choice(form, preset="best")
        assert asked.wants_field(1000.0, 1e-3) is fitted
    asked.wants_field(1000.0, 1e-3)
    asked.triangles()
    assert form.asked[-1] == ("best", budget.mesh, budget.worth * 1000)
    larger = SIZE * (1 + budget.worth) / 2
    for preset, taken in (("best", True), ("balanced", False)):
        found = SimpleNamespace(parts=(PART,) * 9, errors=EXACT, size=larger)
        chosen = choice(Told(larger, best=found), preset=preset).after_fit(FIELD, OFF)
        assert bool(chosen.document.meshes) is taken


def test_triangles_are_worth_more_bytes_where_the_field_makes_up_surface() -> None:
    webbed = replace(OFF, made_up=FaultyPoints(1000, np.zeros((50, 3)), np.zeros(50, np.int32)))
    dear, form = Tuning(forms=FormConfig(most_worth=1e3)), Told(10.0 * SIZE, about=candidate())
    taken = choice(form, tuning=dear).after_fit(FIELD, webbed)
    assert taken.document.meshes == (PART,)
    assert (taken.other_bytes, taken.other_made_up) == (SIZE, 0.05)
    cheap, form = Tuning(forms=FormConfig(most_worth=1e-3)), Told(10.0 * SIZE, about=candidate())
    kept = choice(form, tuning=cheap).after_fit(FIELD, webbed)
    assert (kept.document, kept.other_made_up) == (FIELD, 0.0)
    no_better = Told(10.0 * SIZE, about=candidate(webbed), best=candidate(webbed))
    kept = choice(no_better, tuning=dear).after_fit(FIELD, webbed)
    assert kept.document is FIELD


def test_where_triangles_as_near_make_up_surface_too_nearer_ones_are_taken() -> None:
    webbed = replace(OFF, made_up=FaultyPoints(1000, np.zeros((50, 3)), np.zeros(50, np.int32)))
    for about, asked in ((candidate(), ["about"]), (candidate(webbed), ["about", "best"])):
        form = Told(10.0 * SIZE, about=about, best=candidate())
        dear = Tuning(forms=FormConfig(most_worth=1e3))
        assert choice(form, tuning=dear).after_fit(FIELD, webbed).document.meshes == (PART,)
        assert [name for name, *_ in form.asked] == asked


def test_larger_triangles_are_not() -> None:
    chosen = choice(Told(10.0 * SIZE, about=candidate())).after_fit(FIELD, OFF)
    assert (chosen.document, chosen.errors) == (FIELD, OFF)


def test_networks_asked_for_are_kept_whatever_triangles_take() -> None:
    form = Told(1.0, best=candidate())
    assert choice(form, geometry="field").after_fit(FIELD, OFF).document is FIELD
    assert form.asked == []


@pytest.mark.parametrize(
    ("errors", "mesh"),
    [
        (EXACT, True),
        (replace(OFF, distance=1.0), False),
        (replace(OFF, uv=1.0), False),
        (replace(OFF, distance=0.009, uv_median=0.04), False),
        (replace(OFF, distance=1.0, far_part=0.995), True),
    ],
)
def test_to_a_size_the_better_form_is_taken(errors: Errors, mesh: bool) -> None:
    form = Told(10.0, of_size=candidate(errors), fewest=candidate())
    chosen = choice(form, target_size=SIZE).after_fit(FIELD, OFF)
    assert bool(chosen.document.meshes) is mesh


@pytest.mark.parametrize(
    ("distance", "size", "fitted"), [(5e-5, SIZE, False), (5e-4, SIZE, True), (5e-5, 20.0, True)]
)
def test_to_a_size_nothing_is_fitted_where_triangles_are_surely_nearer(
    distance: float, size: float, fitted: bool
) -> None:
    near = candidate(Errors(distance, distance, 1e-4, 1e-4))
    asked = choice(Told(of_size=near, fewest=near), target_size=size)
    assert asked.wants_field(size, 1e-3) is fitted
    assert asked.settled is not fitted
    assert not choice(Told(of_size=near, fewest=near), geometry="field", target_size=size).settled


@pytest.mark.parametrize(
    ("errors", "size", "settled"),
    [
        (EXACT, 2000, True),
        (EXACT, 8000, False),
        (replace(EXACT, distance=1e-3), 2000, False),
        (replace(EXACT, made_up=FaultyPoints(1000, np.zeros((1, 3)))), 2000, False),
    ],
)
def test_nothing_is_fitted_where_triangles_are_surely_better(
    errors: Errors, size: int, settled: bool
) -> None:
    few = SimpleNamespace(parts=(PART,), errors=errors, size=size)
    form = Told(least_cost=4.0, best=few)
    found = choice(form)
    assert found.settled is settled
    assert found.triangles().document.meshes == (PART,)
    # Looked at in as few bytes as they would have to take, and then as the whole asset wants.
    (_, _, few_bytes), (_, _, most_bytes) = form.asked
    assert few_bytes == pytest.approx(3580, rel=0.01)
    assert most_bytes == math.inf


@pytest.mark.parametrize("options", [{"geometry": "field"}, {"target_error": 1e-3}])
def test_what_is_asked_for_is_not_settled(options: dict[str, Any]) -> None:
    few = SimpleNamespace(parts=(PART,), errors=EXACT, size=100)
    assert not choice(Told(least_cost=4.0, best=few), **options).settled


def test_many_faces_are_not_looked_at_early() -> None:
    form = Told(least_cost=4.6)
    assert not choice(form).settled
    assert form.asked == []


def test_triangles_over_the_size_are_not_taken_however_near() -> None:
    form = Told(10.0, of_size=candidate(EXACT), fewest=candidate())
    size = own_bytes(pack(as_mesh(None, (PART,))))
    chosen = choice(form, target_size=size - 1).after_fit(FIELD, OFF)
    assert (chosen.document, chosen.errors, chosen.other_bytes) == (FIELD, OFF, size)


def test_to_an_error_the_smaller_form_is_taken() -> None:
    form = Told(10.0, within=candidate())
    assert choice(form, target_error=0.01).after_fit(FIELD, OFF).document.meshes == (PART,)
    assert form.asked == [("within", 0.01, OFF.uv)]
    assert choice(Told(10.0), target_error=0.01).after_fit(FIELD, OFF).document is FIELD


def test_triangles_asked_for_are_as_near_as_the_preset_says() -> None:
    form = Told(best=candidate())
    chosen = choice(form, geometry="mesh", preset="best").triangles()
    assert chosen.document.meshes == (PART,)
    assert form.asked == [("best", Tuning().training.budgets["best"].mesh, math.inf)]


def test_targets_that_triangles_miss_are_errors() -> None:
    with pytest.raises(FitError, match="target error"):
        choice(Told(), geometry="mesh", target_error=1e-6).triangles()
    form = Told(of_size=candidate(), fewest=candidate())
    small = choice(form, geometry="mesh", target_size=20)
    with pytest.raises(TargetSizeError, match="target size: expected at least") as refused:
        small.triangles()
    assert refused.value.least == own_bytes(pack(as_mesh(None, (PART,))))
    wide = choice(form, geometry="mesh", target_size=20_000)
    assert wide.triangles().document.meshes == (PART,)


@pytest.mark.parametrize("networks", [50, 50_000])
def test_without_networks_triangles_that_fit_are_left_and_else_the_least_of_both_is_told(
    networks: int,
) -> None:
    form, triangles = (
        Told(of_size=candidate(), fewest=candidate()),
        own_bytes(pack(as_mesh(None, (PART,)))),
    )
    for size in (triangles, triangles - 1):
        found, refused = choice(form, target_size=size), TargetSizeError(networks, size)
        if size == triangles:
            found.without_networks(refused)
            assert found.triangles().document.meshes == (PART,)
            continue
        with pytest.raises(TargetSizeError) as told:
            found.without_networks(refused)
        assert (told.value.least, told.value.found) == (min(networks, triangles), size)


def test_who_asks_for_networks_is_told_their_least() -> None:
    form, refused = Told(of_size=candidate(), fewest=candidate()), TargetSizeError(50_000, 40_000)
    with pytest.raises(TargetSizeError) as told:
        choice(form, geometry="field", target_size=40_000).without_networks(refused)
    assert told.value is refused


def test_where_nothing_has_a_finite_loss_triangles_have_the_target_size() -> None:
    small: Any = SimpleNamespace(**{**vars(candidate()), "errors": OFF})
    form: Any = Told(of_least_loss=candidate(), of_size=small, fewest=candidate())
    for lost, errors in ((math.inf, OFF), (1.0, EXACT)):
        how = EncodeConfig(geometry="mesh", target_size=10 * SIZE)

        def loss(document: Document, lost: float = lost) -> float:
            return lost

        found = Choice(form, how, TUNING, lambda _: None, tried, as_mesh, as_chosen, loss)
        assert found.triangles().errors == errors


@pytest.mark.parametrize(("of_mesh", "taken"), [(1.0, "mesh"), (3.0, "field")])
def test_what_loses_less_is_taken_whatever_its_size(of_mesh: float, taken: str) -> None:
    def loss(document: Document) -> float:
        return 2.0 if document.field else of_mesh

    form: Any = Told(1e9, of_least_loss=candidate(OFF))
    found = Choice(form, EncodeConfig(), TUNING, lambda _: None, tried, as_mesh, as_chosen, loss)
    chosen = found.after_fit(FIELD, EXACT)
    assert ("field" if chosen.document.field else "mesh") == taken
    assert found.triangles().errors == OFF


def test_networks_that_were_asked_for_stay_whatever_loses_less() -> None:
    form: Any = Told(of_least_loss=candidate())
    how = EncodeConfig(geometry="field")

    def loss(document: Document) -> float:
        return 1.0 if document.field else 0.0

    found = Choice(form, how, TUNING, lambda _: None, tried, as_mesh, as_chosen, loss)
    assert found.after_fit(FIELD, OFF).document.field
