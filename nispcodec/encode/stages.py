"""How far an encode is as a whole: its stages, weighted by the seconds that they usually take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import accumulate

from nispcodec.core.progress import Listener, Progress
from nispcodec.encode.config import EncodeConfig
from nispcodec.train.config import TrainConfig


@dataclass(frozen=True)
class StageSeconds:
    """Seconds on two cores for an asset of 6,000 faces.

    before    of the stages before the fit, in their order
    after     of what follows it
    steps     steps of a preset's SDF in a second, the other networks beside it
    paper     of the fit of the preset `paper`
    rounding  share of a network's fit after which its weights are rounded
    """

    before: Mapping[str, float] = field(
        default_factory=lambda: {
            "textures": 0.5,
            "charts and hidden walls": 0.7,
            "samples": 2.0,
            "probe how much there is to learn": 1.0,
            "triangles": 1.0,
        }
    )
    after: float = 0.3
    steps: float = 2000.0
    paper: float = 1200.0
    rounding: float = 0.93


def with_overall(listen: Listener, config: EncodeConfig, training: TrainConfig) -> Listener:
    """A listener that passes every update on to `listen`, with `overall` set; for one encode."""
    usual = StageSeconds()
    seconds = usual.paper
    if config.preset != "paper":
        seconds = training.budgets[config.preset].steps / usual.steps
    rounds = [len(pruning.rates) for pruning in config.prunings().values()]
    searched = config.target_error is not None
    seconds *= (1 + max(rounds, default=0)) * (1 + searched)
    return _Whole(listen, usual, seconds, _Fit(searched, usual.rounding))


class _Whole:
    """Shares never fall: what is told too late or out of order changes nothing."""

    def __init__(self, listen: Listener, usual: StageSeconds, seconds: float, fit: _Fit) -> None:
        total = sum(usual.before.values()) + seconds + usual.after
        ends = [end / total for end in accumulate(usual.before.values())]
        starts = [0.0, *ends[:-1]]
        self._listen = listen
        self._spans = dict(zip(usual.before, zip(starts, ends, strict=True), strict=True))
        self._fit_span = (ends[-1], 1 - usual.after / total)
        self._fit = fit
        self._overall = 0.0

    def __call__(self, update: Progress) -> None:
        self._overall = max(self._overall, self._share(update))
        self._listen(replace(update, overall=self._overall))

    def _share(self, update: Progress) -> float:
        if update.network:
            return _within(self._fit_span, self._fit.share(update))
        if update.stage == "surface":
            return self._fit_span[1]
        done = update.step / update.steps if update.steps else 0.0
        return _within(self._spans[update.stage], done) if update.stage in self._spans else 0.0


class _Fit:
    """The share of all networks' fits that is done: that of the one that is least far.

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
        return _within(span, min(self._done.values(), default=0.0))

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
