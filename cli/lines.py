"""Progress as plain lines, one each ten percent of the whole, and its wording."""

from __future__ import annotations

import time
from math import isnan, nan
from types import TracebackType
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from nispcodec.core.progress import Listener, Progress

TENTHS = 10
LEAST_KNOWN = 0.02
"""A share from which on the time that is left can be told."""


class Whole:
    """How far the whole work is, and how long the rest takes, from what is told of it."""

    def __init__(self) -> None:
        self.share = 0.0
        self._started = time.monotonic()

    def hear(self, update: Progress) -> None:
        """Take the share of an update, where it tells one; it never falls."""
        share = update.overall
        if isnan(share) and not update.network and update.steps:
            share = update.step / update.steps
        if share > self.share:
            self.share = min(share, 1.0)

    @property
    def seconds(self) -> float:
        """Since the start."""
        return time.monotonic() - self._started

    @property
    def seconds_left(self) -> float:
        """As if the rest were as fast as what is done; NaN at the very start."""
        if self.share < LEAST_KNOWN:
            return nan
        return self.seconds * (1 - self.share) / self.share


class Lines:
    """A plain line each ten percent of the whole, and one for every note."""

    def __init__(self, title: str) -> None:
        self._title = title
        self._whole = Whole()
        self._tenths = 0
        self._stages: dict[str, str] = {}

    def __enter__(self) -> Listener:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            click.echo(f"{self._title} 100 %: {duration(self._whole.seconds)}", err=True)

    def __call__(self, update: Progress) -> None:
        """Print the update if it is worth a line."""
        self._whole.hear(update)
        self._stages[update.network] = _state(update)
        if update.note:
            click.echo(noted(update), err=True)
        tenths = int(TENTHS * self._whole.share + 1e-9)
        if self._tenths < tenths < TENTHS:
            self._tenths = tenths
            click.echo(self._line(), err=True)

    def _line(self) -> str:
        networks = [text for network, text in self._stages.items() if network]
        doing = ", ".join(networks or self._stages.values())
        left = duration(self._whole.seconds_left)
        return f"{self._title} {self._tenths * 10:3d} %, about {left} left: {doing}"


def noted(update: Progress) -> str:
    """The note of an update, and whose it is: `uv fit: diverged at step 90`."""
    return f"{head(update)}: {update.note}"


def head(update: Progress) -> str:
    """Who does what: `uv fit`."""
    return f"{update.network} {update.stage}".strip()


def facts(update: Progress) -> list[str]:
    """What is known of an update, a few words each."""
    known = {
        "{}": f"{update.step}/{update.steps}" if update.steps else None,
        "loss {}": _number(update.loss),
        "held-out {}": _number(update.error),
        "{} left": None if isnan(update.seconds_left) else duration(update.seconds_left),
    }
    return [text.format(value) for text, value in known.items() if value]


def _state(update: Progress) -> str:
    """`uv fit 38 %`."""
    return f"{head(update)} {percent(update.step / update.steps)}" if update.steps else head(update)


def percent(share: float) -> str:
    """`38 %`."""
    return f"{100 * share:.0f} %"


def _number(value: float) -> str | None:
    return None if isnan(value) else f"{value:.1e}"


def duration(seconds: float) -> str:
    """`0.4 s`, `12 s`, `1 min 20 s`, `3 h 20 min`."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes >= 60:
        return f"{minutes // 60} h {minutes % 60} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
