"""Fits to a size and to an error: real ones of a ball, and made-up ones with a known law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from nispcodec import Material, NispError
from nispcodec.core.document import ChartTable, Document, Field, Frame
from nispcodec.core.errors import FitError, TargetSizeError
from nispcodec.core.network import Network
from nispcodec.core.progress import Listener, Progress, silent
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.encode.targets import (
    Fit,
    FitContext,
    Networks,
    fit_to_error,
    fit_to_size,
    fit_with_preset,
)
from nispcodec.format import pack
from nispcodec.train.config import TargetConfig, TrainingBudget
from nispcodec.train.task import Task
from nispcodec.train.tasks import AssetProblem
from nispcodec.train.workers import fit_networks
from tests.train.fits import ENGINE, ball_samples

TABLE = ChartTable(materials=np.zeros(1, np.int32), has_uv=np.zeros(1, np.bool_))


def problem() -> AssetProblem:
    samples, held_out = ball_samples(4000, 0), ball_samples(500, 1)
    held_out = replace(held_out, sdf=np.zeros_like(held_out.sdf))
    sets = TrainingSets(samples, samples, samples, held_out, held_out, samples[:0])
    return AssetProblem(sets, 1, False, 5.0, 0, 0)


def really(tasks: list[Task], listen: Listener) -> Networks:
    return fit_networks(tasks, 0, ENGINE, 2, listen)


def by_law(tasks: list[Task], listen: Listener) -> Networks:
    """Networks that are a constant, which is their error as all held-out distances are 0."""
    networks = {}
    for task in tasks:
        listen(Progress(task.name, "fit", 1, 1, error=1e-3))
        spec = task.spec
        tensors = {name: np.zeros(shape, np.float32) for name, shape in spec.shapes.items()}
        tensors[f"bias.{len(spec.hidden)}"][:] = 0.02 / spec.hidden[0] ** 1.2
        networks[task.name] = Network(spec, tensors)
    return networks


def fitting(fit: Fit = by_law, listen: Listener = silent) -> FitContext:
    return FitContext(problem(), TrainingBudget(900, 0.5, 1, 100), fit, listen)


def document(networks: Mapping[str, Network]) -> Document:
    frame = Frame((0.0, 0.0, 0.0), 1.0)
    return Document(frame, (Material("one"),), (), Field(TABLE, networks["sdf"]))


def always(size: float, probe_error: float) -> bool:
    return True


@pytest.mark.slow
@pytest.mark.parametrize("wanted", [1500, 3000])
def test_the_file_has_the_size_that_was_asked_for(wanted: int) -> None:
    data = pack(document(fit_to_size(fitting(really), wanted, document)))
    assert 0.94 * wanted < len(data) <= wanted


@pytest.mark.parametrize("wanted", [3e-4, 1e-4, 5e-4])
def test_the_error_is_the_one_that_was_asked_for(wanted: float) -> None:
    network = fit_to_error(fitting(), wanted)["sdf"]
    assert 0.02 / network.spec.hidden[0] ** 1.2 == pytest.approx(wanted, rel=0.1)


def test_every_try_is_told() -> None:
    notes: list[str] = []
    fit_to_error(fitting(listen=lambda update: notes.append(update.note)), 1e-4)
    told = [note for note in notes if note]
    assert len(told) > 1
    assert all("asked 0.0001" in note for note in told)


def test_no_try_is_made_twice_where_the_smallest_network_is_good_enough() -> None:
    spec = fit_to_error(fitting(), 1e-2)["sdf"].spec
    assert spec.hidden[0] == 8


def test_targets_out_of_reach_are_errors_before_any_training() -> None:
    def never(tasks: list[Task], listen: Listener) -> Networks:
        raise AssertionError("trained")

    with pytest.raises(TargetSizeError, match=r"target size: expected at least \d+ bytes"):
        fit_to_size(fitting(never), 100, document)
    with pytest.raises(NispError, match="target error: expected at least"):
        fit_to_error(fitting(never), 1e-9)


def test_an_error_that_no_width_reaches_says_what_was_reached() -> None:
    with pytest.raises(FitError, match=r"target error: expected 2e-05 .* width 128"):
        fit_to_error(fitting(), 2e-5)


def test_the_probe_decides_the_width() -> None:
    def easier(tasks: list[Task], listen: Listener) -> Networks:
        return by_law(tasks, lambda update: listen(replace(update, error=update.error / 2)))

    widths = [
        fit_with_preset(fitting(fit), always)["sdf"].spec.hidden[0] for fit in (by_law, easier)
    ]
    assert widths[0] > widths[1]


def test_the_last_try_is_kept_even_if_it_is_too_good() -> None:
    context = fitting()
    config = replace(context.problem.config, target=TargetConfig(rounds=1))
    once = replace(context, problem=replace(context.problem, config=config))
    assert "sdf" in fit_to_error(once, 1e-3)


def test_networks_that_are_not_wanted_are_not_fitted() -> None:
    told: list[tuple[float, float]] = []

    def never(size: float, probe_error: float) -> bool:
        told.append((size, probe_error))
        return False

    assert fit_with_preset(fitting(), never) == {}
    assert fit_to_size(fitting(), 3000, document, never) == {}
    for size, error in told:
        assert 100 < size < 100_000
        assert 0 < error < 1
    assert told[1][0] == 3000


@dataclass
class Law:
    """Fits whose files have the fewer bytes, the more coarsely they are rounded."""

    bytes: float
    per_octave: float = 400.0
    asked: list[float] = field(default_factory=list)
    fits: int = 0

    def fit(self, tasks: list[Task], listen: Listener) -> Networks:
        for task in tasks:
            if task.fitted is not None and task.quantization is not None:
                self.asked.append(task.quantization.coarser)
            else:
                self.fits += 1
        return by_law(tasks, listen)

    def document(self, networks: Mapping[str, Network]) -> Document:
        size = self.bytes - self.per_octave * self.asked[-1] if self.asked else 0.0
        count = max(round((size - len(pack(document(networks)))) / 10), 0)
        random = np.random.default_rng(0).random(count).tolist()
        info = {str(number): value for number, value in enumerate(random)}
        return replace(document(networks), info=info)


@pytest.mark.parametrize("size", [2000.0, 3300.0, 4500.0])
@pytest.mark.parametrize("per_octave", [100.0, 400.0, 1000.0])
def test_networks_are_fitted_once_and_rounded_until_they_fill_the_size(
    size: float, per_octave: float
) -> None:
    law = Law(size, per_octave)
    networks = fit_to_size(fitting(law.fit), 3000, law.document)
    found = len(pack(law.document(networks)))
    assert 0.9 * 3000 < found <= 3000
    assert law.fits == 2  # the probe's and the fit's
    assert len(law.asked) <= TargetConfig.roundings


def test_networks_that_no_rounding_makes_small_enough_are_refused() -> None:
    law = Law(9000.0, per_octave=0.0)
    with pytest.raises(TargetSizeError, match=r"target size: expected at least \d,\d{3} bytes"):
        fit_to_size(fitting(law.fit), 3000, law.document)
    assert len(law.asked) == TargetConfig.roundings


@pytest.mark.slow
def test_a_network_that_was_fitted_before_is_only_rounded() -> None:
    context = fitting(really)
    (task,) = context.tasks({"sdf": (8,) * 4}, context.probed)
    plain = replace(task, quantization=None)
    before = really([plain], silent)["sdf"]
    told: list[str] = []
    again = fit_networks(
        [replace(task, fitted=before)], 0, ENGINE, 2, lambda update: told.append(update.stage)
    )["sdf"]
    assert set(told) == {"quantize"}
    assert again.spec == before.spec
    off = np.abs(again.tensors["weight.1"] - before.tensors["weight.1"])
    assert 0 < off.max() < again.steps["weight.1"] * 16
