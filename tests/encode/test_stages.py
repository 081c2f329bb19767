"""The share of the whole encode: never less than before, and no stage that it does not know."""

from __future__ import annotations

from dataclasses import replace

import pytest

import nispcodec
from nispcodec import EncodeConfig, Progress
from nispcodec.encode.config import GEOMETRIES
from nispcodec.encode.stages import StageSeconds, with_overall
from nispcodec.encode.targets import TRIAL
from nispcodec.train.config import TrainConfig
from tests.encode.test_recipe import box
from tests.geometry.shapes import box_asset


def overall(updates: list[Progress], config: EncodeConfig | None = None) -> list[float]:
    """The shares that are told for these updates."""
    heard: list[Progress] = []
    listen = with_overall(heard.append, config or EncodeConfig(), TrainConfig())
    for update in updates:
        listen(update)
    assert [replace(each, overall=0.0) for each in heard] == [
        replace(each, overall=0.0) for each in updates
    ]
    return [each.overall for each in heard]


def fit(network: str, share: float) -> Progress:
    return Progress(network, "fit", step=round(100 * share), steps=100)


def rounded(network: str) -> Progress:
    return Progress(network, "quantize", step=100, steps=100, note="done")


@pytest.mark.slow
@pytest.mark.parametrize(
    "config",
    [
        EncodeConfig(),
        EncodeConfig("paper"),
        EncodeConfig(prune="smallest", prune_rate={"uv": 0.4}),
        EncodeConfig(target_error=0.05),
    ],
)
def test_a_real_encode_goes_from_0_to_nearly_1_and_never_back(config: EncodeConfig) -> None:
    _, seen = box(config)
    shares = [each.overall for each in seen]
    assert shares[0] == 0
    assert shares == sorted(shares)
    assert shares[-1] == 1
    known = {*StageSeconds().of(EncodeConfig(), TrainConfig()), "fit"}
    assert {each.stage for each in seen if not each.network} <= known


def test_a_real_encode_as_triangles_goes_on_with_every_candidate() -> None:
    seen: list[Progress] = []
    nispcodec.encode(box_asset(), EncodeConfig(geometry="mesh"), seen.append)
    assert len({each.overall for each in seen if each.stage == "triangles"}) > 3
    shares = [each.overall for each in seen]
    assert shares == sorted(shares)
    assert (shares[0], shares[-1]) == (0, 1)


def test_a_trial_leaves_room_for_the_fit() -> None:
    tried = [Progress(stage="samples"), Progress(stage=TRIAL, step=2, steps=2)]
    measured = [Progress(stage=TRIAL, step=step, steps=2) for step in (0, 1)]
    made = [Progress(stage="probe triangles", step=step) for step in (1, 2)]
    surface = Progress(stage="surface", step=0, steps=2)
    shares = overall([*tried, *measured, *made, fit("sdf", 0.5), surface])
    assert shares == sorted(shares)
    assert shares[1] == shares[5] < 0.5 < shares[6] < shares[7]


@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_each_stage_is_further_than_the_one_before(geometry: str) -> None:
    config = EncodeConfig(geometry=geometry)
    names = StageSeconds().of(config, TrainConfig())
    stages = [
        fit("sdf", 0) if name == "networks" else Progress(stage=name, step=step, steps=2)
        for name in names
        for step in (1, 2)
    ]
    shares = overall(stages, config)
    assert shares == sorted(shares)
    # The fit begins where the stage before it ends.
    assert len(set(shares)) == len(stages) - 2 * ("networks" in names)


def test_candidates_go_on_without_an_end_as_nobody_knows_how_many_there_will_be() -> None:
    made = [Progress(stage="triangles", step=step) for step in range(30)]
    before = [Progress(stage="samples"), Progress(stage="probe triangles", step=1, steps=4)]
    shares = overall([*before, *made])[1:]
    assert shares[1:] == sorted(set(shares[1:]))
    assert 0.95 < shares[-1] < 1


def test_triangles_that_are_looked_at_after_a_fit_go_on_too() -> None:
    looks = [Progress(stage="probe triangles", step=step, steps=4) for step in (1, 2)]
    shares = overall([fit("sdf", 1), rounded("sdf"), *looks, Progress(stage="triangles", step=1)])
    assert shares == sorted(set(shares))


def test_networks_that_are_looked_at_after_triangles_share_what_is_left() -> None:
    made = [Progress(stage="triangles", step=step) for step in range(1, 30)]
    networks = [Progress(stage="samples"), fit("sdf", 0.1), fit("sdf", 0.2), fit("sdf", 1)]
    shares = overall([*made, *networks, *made])
    assert shares == sorted(shares)
    first, last = shares[len(made) - 1], shares[len(made) + 3]
    assert 0.45 < first < 0.5 < shares[len(made) + 1] < shares[len(made) + 2] < 0.75 < last < 1


def test_every_network_moves_the_whole() -> None:
    alone = overall([fit("sdf", 0.3)])[-1]
    both, further = overall([fit("uv", 0.3), fit("sdf", 0.3), fit("uv", 0.9)])[1:]
    assert both == pytest.approx(alone)
    assert further > both


def test_a_fit_is_done_when_the_weights_are_rounded() -> None:
    before, after = overall([fit("sdf", 1), rounded("sdf")])
    assert before < after


def test_longer_presets_spend_less_of_their_time_before_the_fit() -> None:
    shares = [
        overall([fit("sdf", 0)], EncodeConfig(preset))[0] for preset in ("best", "balanced", "fast")
    ]
    assert shares == sorted(set(shares))


def test_a_search_leaves_room_for_another_fit() -> None:
    again = [fit("sdf", 1), rounded("sdf"), fit("sdf", 0.5), fit("sdf", 1), fit("sdf", 0.5)]
    shares = overall(again, EncodeConfig(target_error=1e-3))
    assert shares == sorted(set(shares))
    assert shares[1] < 0.6
    assert shares[-1] < 1


def test_a_note_without_steps_changes_nothing() -> None:
    first, second = overall([fit("sdf", 0.5), Progress("sdf", "fit", note="sdf of width 20")])
    assert first == second
