"""Pruning: masks of the asked share, each within the one before, and zero where they say so."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from nispcodec.core.arrays import Float32Array
from nispcodec.core.errors import FitError, NispError
from nispcodec.core.network import Network, NetworkSpec
from nispcodec.core.progress import Progress, silent
from nispcodec.format import pack, unpack
from nispcodec.train.cores import one_core
from nispcodec.train.layout import WeightLayout
from nispcodec.train.lottery_ticket import fit, lottery_ticket
from nispcodec.train.prune import (
    NETWORKS,
    STRATEGIES,
    Mask,
    Pruning,
    Strategy,
    density,
    everything,
    large_final,
    prunings,
    smallest,
    smallest_global,
)
from nispcodec.train.task import Quantization, Schedule
from tests import tiny
from tests.train.fits import ENGINE, run, sdf_task

SPEC = NetworkSpec((12, 7), 2, conditioning="chart_affine", charts=4, embedding=3)


def weights(seed: int = 0) -> dict[str, Float32Array]:
    """Matrices of `SPEC`, the later the larger."""
    rng = np.random.default_rng(seed)
    scales = {name: 1.0 + 3.0 * number for number, name in enumerate(everything(SPEC))}
    return {
        name: rng.normal(0, scales.get(name, 1.0), shape).astype(np.float32)
        for name, shape in SPEC.shapes.items()
    }


def within(inner: Mask, outer: Mask) -> bool:
    return all(not (inner[name] & ~outer[name]).any() for name in outer)


@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize("rate", [0.0, 0.2, 0.844, 0.9939, 0.99999])
def test_the_asked_share_is_pruned(strategy: str, rate: float) -> None:
    mask = STRATEGIES[strategy](weights(), everything(SPEC), rate)
    assert list(mask) == ["weight.0", "weight.1", "weight.2"]
    parts = [mask] if strategy == "smallest_global" else [{n: m} for n, m in mask.items()]
    for part in parts:
        size = sum(kept.size for kept in part.values())
        assert sum(int(kept.sum()) for kept in part.values()) == size - int(rate * size) >= 1


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_round_prunes_nothing_that_is_not_within_the_mask_before(strategy: str) -> None:
    first = STRATEGIES[strategy](weights(0), everything(SPEC), 0.3)
    second = STRATEGIES[strategy](weights(1), first, 0.6)
    assert within(second, first)
    assert density(second) == pytest.approx(0.4, abs=0.02)
    assert STRATEGIES[strategy](weights(2), second, 0.3).keys() == second.keys()
    assert density(STRATEGIES[strategy](weights(2), second, 0.3)) == density(second)


@pytest.mark.parametrize("strategy", [smallest, large_final])
def test_a_matrix_keeps_its_largest(strategy: Strategy) -> None:
    values = weights()
    for name, kept in strategy(values, everything(SPEC), 0.5).items():
        assert np.abs(values[name])[kept].min() >= np.abs(values[name])[~kept].max()


def test_the_network_keeps_its_largest() -> None:
    values = weights()
    mask = smallest_global(values, everything(SPEC), 0.5)
    kept = np.concatenate([np.abs(values[name])[mask[name]] for name in mask])
    pruned = np.concatenate([np.abs(values[name])[~mask[name]] for name in mask])
    assert kept.min() >= pruned.max()
    assert mask["weight.0"].mean() < 0.5 < mask["weight.2"].mean()


def test_the_inputs_of_a_strategy_stay_as_they_are() -> None:
    values, mask = weights(), everything(SPEC)
    for strategy in STRATEGIES.values():
        strategy(values, mask, 0.9)
    assert density(mask) == 1
    assert all(np.array_equal(values[name], weights()[name]) for name in values)


@pytest.mark.parametrize("rounds", [1, 2, 5])
def test_every_round_prunes_the_same_share_of_what_is_left(rounds: int) -> None:
    rates = Pruning("smallest", 0.844, rounds).rates
    assert len(rates) == rounds
    assert rates[-1] == 0.844
    left = [1.0, *(1 - rate for rate in rates)]
    ratios = [after / before for before, after in pairwise(left)]
    assert ratios == pytest.approx([ratios[0]] * rounds)


def test_the_final_weights_are_ranked_once() -> None:
    assert Pruning("large_final", 0.7, 5).rates == [0.7]


def test_a_rate_for_all_or_for_each() -> None:
    assert set(prunings("smallest", 0.5, 2)) == set(NETWORKS)
    assert prunings("smallest", {"uv": 0.25, "sdf": 0.0}, 2) == {"uv": Pruning("smallest", 0.25, 2)}


@pytest.mark.parametrize(
    ("strategy", "rate", "rounds", "said"),
    [
        (
            "random",
            0.5,
            1,
            "expected one of smallest, smallest_global, large_final, found 'random'",
        ),
        ("smallest", 1.0, 1, "rate of sdf: expected 0 to below 1, found 1"),
        ("smallest", float("nan"), 1, "found nan"),
        ("smallest", {"uv": 84.4}, 1, "rate of uv: expected 0 to below 1, found 84.4"),
        ("smallest", {"color": 0.5}, 1, "expected sdf, chart, uv, found 'color'"),
        ("smallest", 0.5, 0, "rounds: expected 1 or more, found 0"),
    ],
)
def test_what_makes_no_sense_is_an_error(
    strategy: str, rate: float | dict[str, float], rounds: int, said: str
) -> None:
    with pytest.raises(NispError, match=said):
        prunings(strategy, rate, rounds)


def written(network: Network) -> Network:
    """The network as it comes back from a file."""
    return unpack(pack(tiny.document(sdf=network))).networks["sdf"]


@pytest.mark.parametrize("optimizer", ["muon", "adam"])
@pytest.mark.parametrize("lambda_", [0.0, 1e-4])
def test_what_is_pruned_is_exactly_zero_in_the_file(optimizer: str, lambda_: float) -> None:
    quantization = Quantization(lambda_) if lambda_ else None
    task = replace(
        sdf_task(), schedule=Schedule(80, 128, optimizer=optimizer), quantization=quantization
    )
    rng = np.random.default_rng(0)
    mask = {name: rng.random(kept.shape) < 0.4 for name, kept in everything(task.spec).items()}
    network = written(run(task, mask=mask))
    assert bool(network.steps) == (lambda_ > 0)
    for name, kept in mask.items():
        assert (network.tensors[name][~kept] == 0).all()
        assert (network.tensors[name][kept] != 0).mean() > 0.5
    assert (network.tensors["bias.0"] != 0).mean() > 0.5


def test_a_pruned_weight_has_no_gradient() -> None:
    task = sdf_task()
    mask = {name: np.zeros_like(kept) for name, kept in everything(task.spec).items()}
    mask["weight.1"][0, 0] = True
    layout = WeightLayout(task.spec)
    kept = layout.kept(mask)
    assert kept is not None
    assert kept.sum() == 1 + 16 + 16 + 1
    trainer = ENGINE.trainer(task, np.ones(task.spec.weight_count, np.float32), kept)
    _, gradient = trainer.gradient(np.arange(9, dtype=np.int32))
    assert not gradient[kept == 0].any()
    assert gradient[kept == 1].any()


def test_every_round_starts_from_the_same_weights() -> None:
    task = replace(sdf_task(), schedule=Schedule(1, 64, rate=0.0))
    initial = run(task, seed=3)
    mask = smallest(initial.tensors, everything(task.spec), 0.5)
    rewound = run(task, seed=3, mask=mask)
    for name, kept in mask.items():
        assert np.array_equal(rewound.tensors[name], initial.tensors[name] * kept)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_ticket_is_judged_by_the_round_before_or_the_first(strategy: str) -> None:
    task = sdf_task()
    made: list[tuple[float, Mask, Network]] = []

    def trained(mask: Mask, rate: float) -> Network:
        made.append((rate, mask, tiny.random_network(task.spec, len(made))))
        return made[-1][2]

    networks = list(lottery_ticket(task, strategy, [0.4, 0.7], trained))
    assert networks == [network for *_, network in made]
    assert [rate for rate, *_ in made] == [0.0, 0.4, 0.7]
    judged = made[0 if strategy == "large_final" else 1][2].tensors
    expected = STRATEGIES[strategy](judged, made[1][1], 0.7)
    assert all(np.array_equal(made[2][1][name], expected[name]) for name in expected)


def test_a_network_that_would_be_a_constant_is_an_error() -> None:
    pruning = Pruning("smallest_global", 0.995, 1)
    task = replace(sdf_task(), schedule=Schedule(2, 64), pruning=pruning)
    with pytest.raises(FitError, match=r"sdf network: nothing is left of weight.*lower prune rate"):
        fit(task, 0, ENGINE, one_core, silent)


def test_rounds_are_told_and_only_the_last_is_quantized() -> None:
    seen: list[Progress] = []
    quantization = Quantization(1e-4)
    task = replace(sdf_task(), schedule=Schedule(50, 128), quantization=quantization)
    task = replace(task, pruning=Pruning("smallest", 0.75, 2))
    network = fit(task, 0, ENGINE, one_core, seen.append)
    stages = list(dict.fromkeys(update.stage for update in seen))
    fits = [f"fit, round {number} of 3" for number in (1, 2, 3)]
    assert stages == [*fits, "quantize, round 3 of 3"]
    assert [update.step for update in seen] == sorted(update.step for update in seen)
    assert {update.steps for update in seen} == {150}
    assert seen[-1].seconds_left == 0
    assert network.steps
    for name in everything(task.spec):
        assert (network.tensors[name] == 0).mean() >= 0.74
