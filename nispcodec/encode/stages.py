"""How far an encode is as a whole: its stages, weighted by the seconds that they usually take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import accumulate, pairwise
from statistics import fmean

from nispcodec.core.progress import Listener, Progress
from nispcodec.encode.config import EncodeConfig
from nispcodec.encode.targets import TRIAL
from nispcodec.train.config import TrainConfig


@dataclass(frozen=True)
class StageSeconds:
    """Seconds on two cores: about the mean of a knight, a cow, a cabinet and a tea set.

    first      of the stages that every encode begins with, in their order
    networks   of those before networks are fitted
    estimate   of looking at triangles before that
    trial      of networks that are looked at before they are fitted
    triangles  of the candidates, where the asset is to be triangles
    surface    of measuring what networks decode to
    steps      steps of a preset's SDF in a second, the other networks beside it
    paper      of the fit of the preset `paper`
    rounding   share of a network's fit after which its weights are rounded
    candidate  share of what is left that a candidate takes, as nobody knows how many there will be
    """

    first: Mapping[str, float] = field(
        default_factory=lambda: {"textures": 0.2, "charts and hidden walls": 1.1}
    )
    networks: Mapping[str, float] = field(
        default_factory=lambda: {"samples": 2.5, "probe how much there is to learn": 1.5}
    )
    estimate: float = 4.5
    trial: float = 4.0
    triangles: float = 8.0
    surface: float = 2.5
    steps: float = 2000.0
    paper: float = 1200.0
    rounding: float = 0.93
    candidate: float = 0.2

    def of(self, config: EncodeConfig, training: TrainConfig) -> dict[str, float]:
        """The seconds of the stages that such an encode goes through, in their order.

        "networks" is their fit.
        """
        last = {"surface": self.surface}
        if config.geometry == "mesh":
            return {**self.first, "triangles": self.triangles, **last}
        return {
            **self.first,
            **self.networks,
            **(self._looks(config, training) if config.geometry == "auto" else {}),
            "networks": self._fit(config, training),
            **last,
        }

    def _looks(self, config: EncodeConfig, training: TrainConfig) -> dict[str, float]:
        looks, budget = {"probe triangles": self.estimate}, training.budgets.get(config.preset)
        aimed = config.target_size or config.target_total or config.target_error
        if budget and budget.trial and not aimed:
            looks[TRIAL] = self.trial
        return looks

    def _fit(self, config: EncodeConfig, training: TrainConfig) -> float:
        seconds = self.paper
        if config.preset != "paper":
            seconds = training.budgets[config.preset].steps / self.steps
        rounds = [len(pruning.rates) for pruning in config.prunings().values()]
        return seconds * (1 + max(rounds, default=0)) * (1 + (config.target_error is not None))


def with_overall(listen: Listener, config: EncodeConfig, training: TrainConfig) -> Listener:
    """A listener that passes every update on to `listen`, with `overall` set; for one encode."""
    usual = StageSeconds()
    fit = _Fit(config.target_error is not None, usual.rounding)
    seconds, undecided = usual.of(config, training), config.geometry == "auto"
    return _Whole(listen, seconds, fit, usual.candidate, undecided)


class _Whole:
    """Shares never fall: what is told too late or out of order changes nothing.

    Where triangles may be enough they are made first, and have half of the bar; networks that are
    looked at after all share what is left of it. The surface of networks that are only tried is no
    step forward.
    """

    def __init__(
        self,
        listen: Listener,
        seconds: Mapping[str, float],
        fit: _Fit,
        candidate: float,
        undecided: bool,
    ) -> None:
        total = sum(seconds.values())
        ends = [end / total for end in accumulate(seconds.values())]
        self._listen = listen
        self._spans = dict(zip(seconds, pairwise([0.0, *ends]), strict=True))
        self._fit, self._candidate = fit, candidate
        self._undecided, self._fitted = undecided, False
        self._overall = 0.0

    def __call__(self, update: Progress) -> None:
        self._overall = max(self._overall, self._share(update))
        self._listen(replace(update, overall=self._overall))

    def _share(self, update: Progress) -> float:
        if self._undecided and (update.network or update.stage == "samples"):
            self._go_on_with_networks()
        if update.network:
            self._fitted = True
            return _within(self._spans["networks"], self._fit.share(update))
        if update.stage == "triangles" or (update.stage == "probe triangles" and self._fitted):
            return self._of_candidate(update)
        done = min(update.step / update.steps, 1.0) if update.steps else 0.0
        return _within(self._spans.get(update.stage, (0.0, 0.0)), done)

    def _of_candidate(self, update: Progress) -> float:
        span = self._overall, 0.5 if self._undecided else 1.0
        return _within(span, self._candidate if update.step else 0.0)

    def _go_on_with_networks(self) -> None:
        self._undecided = False
        start = self._spans["samples"][0]
        left = (1 - max(self._overall, start)) / (1 - start)
        moved = {
            name: (1 - left * (1 - a), 1 - left * (1 - b)) for name, (a, b) in self._spans.items()
        }
        self._spans = moved


class _Fit:
    """The share of all networks' fits that is done: their mean, as they take turns on few cores.

    A search for an error fits a network again and again: each time takes half of what is left.
    """

    def __init__(self, searched: bool, rounding: float) -> None:
        self._searched = searched
        self._rounding = rounding
        self._rounds = 1
        self._done: dict[str, float] = {}

    def share(self, update: Progress) -> float:
        if update.steps:
            self._hear(update.network, self._fitted(update))
        left = 0.5 if self._searched else 0.0
        span = (1 - 0.5 ** (self._rounds - 1), 1 - left**self._rounds)
        return _within(span, fmean(self._done.values() or [0.0]))

    def _hear(self, network: str, done: float) -> None:
        if done < self._done.get(network, 0.0):
            self._rounds += 1
            self._done.clear()
        self._done[network] = done

    def _fitted(self, update: Progress) -> float:
        """The share of a network's fit that is done, its rounding included."""
        if update.stage.startswith("quantize"):
            return 1.0 if update.note else self._rounding
        return self._rounding * update.step / update.steps


def _within(span: tuple[float, float], share: float) -> float:
    start, end = span
    return start + (end - start) * share
