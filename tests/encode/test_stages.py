"""The share of the whole encode: never less than before, and no stage that it does not know."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nispcodec import EncodeConfig, Progress
from nispcodec.encode.stages import StageSeconds, with_overall
from nispcodec.train.config import TrainConfig
from tests.encode.test_recipe import box


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
    assert 0.45 < shares[-1] < 1
    assert shares[-1] > 0.9 or config.target_error is not None
    known = {*StageSeconds().before, "fit", "surface"}
    assert {each.stage for each in seen if not each.network} <= known


def test_each_stage_before_the_fit_is_further_than_the_one_before() -> None:
    stages = [Progress(stage=stage) for stage in StageSeconds().before]
    half = Progress(stage="triangles", step=1, steps=2)
    shares = overall([*stages, half, fit("sdf", 0.1)])
    assert shares == sorted(set(shares))


def test_the_slowest_network_says_how_far_the_fit_is() -> None:
    alone = overall([fit("sdf", 0.3)])[-1]
    assert overall([fit("uv", 0.3), fit("sdf", 0.3), fit("uv", 0.9)])[-1] == alone
    assert overall([fit("uv", 0.3), fit("sdf", 0.3), fit("uv", 0.9), fit("sdf", 0.5)])[-1] > alone


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
