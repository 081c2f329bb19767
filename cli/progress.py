"""What the user sees while something takes long: bars on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from types import TracebackType
from typing import Protocol

import click

PLAIN_INTERVAL = 5.0


class Update(Protocol):
    """What the encoder tells: see `nispcodec.encoder.Progress`. `network` is "" for the whole."""

    network: str
    stage: str
    step: int
    steps: int
    loss: float | None
    error: float | None
    seconds_left: float | None
    note: str


class Show(Protocol):
    """Takes the encoder's updates."""

    def __call__(self, update: Update) -> None: ...


def encode_progress(quiet: bool) -> AbstractContextManager[Show | None]:
    """Bars on a terminal, a line every few seconds elsewhere, nothing when quiet."""
    if quiet:
        return nullcontext(None)
    return Bars() if sys.stderr.isatty() else nullcontext(Lines())


@contextmanager
def working(text: str) -> Iterator[None]:
    """A spinner beside `text` on a terminal, nothing elsewhere."""
    if not sys.stderr.isatty():
        yield
        return
    from rich.console import Console

    with Console(stderr=True).status(text):
        yield


class Lines:
    """A plain line when a stage begins, for every note, and each PLAIN_INTERVAL seconds."""

    def __init__(self) -> None:
        self._shown: dict[str, tuple[str, float]] = {}

    def __call__(self, update: Update) -> None:
        """Print the update if it is worth a line."""
        stage, when = self._shown.get(update.network, ("", 0.0))
        now = time.monotonic()
        if update.note or update.stage != stage or now - when >= PLAIN_INTERVAL:
            self._shown[update.network] = (update.stage, now)
            click.echo(described(update), err=True)


class Bars:
    """One bar a network and a line for the stage of the whole, redrawn in place."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn

        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=10),
            TextColumn("{task.fields[text]}"),
            console=Console(stderr=True),
        )
        self._tasks: dict[str, int] = {}

    def __enter__(self) -> Show:
        self._progress.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._progress.stop()

    def __call__(self, update: Update) -> None:
        """Move the bar of the update's network; a note stays above the bars."""
        from rich.progress import TaskID

        if update.note:
            self._progress.console.print(described(update))
        if update.network not in self._tasks:
            self._tasks[update.network] = self._progress.add_task("", total=None, text="")
        self._progress.update(
            TaskID(self._tasks[update.network]),
            description=_head(update),
            total=update.steps or None,
            completed=update.step,
            text=" · ".join(_facts(update)),
        )


def described(update: Update) -> str:
    """One plain line: `uv fit: 100/2000, loss 1.0e-03, held-out 3.1e-04, 12 s left`."""
    facts = ", ".join([*_facts(update), *([update.note] if update.note else [])])
    return f"{_head(update)}: {facts}" if facts else _head(update)


def _head(update: Update) -> str:
    return f"{update.network} {update.stage}".strip()


def _facts(update: Update) -> list[str]:
    known = {
        "{}": f"{update.step}/{update.steps}" if update.steps else None,
        "loss {}": _number(update.loss),
        "held-out {}": _number(update.error),
        "{} left": duration(update.seconds_left) if update.seconds_left is not None else None,
    }
    return [text.format(value) for text, value in known.items() if value]


def _number(value: float | None) -> str | None:
    return None if value is None else f"{value:.1e}"


def duration(seconds: float) -> str:
    """`8 s`, `1 min 20 s`."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
