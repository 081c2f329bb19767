"""What the user sees while something takes long: bars on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from math import isnan
from types import TracebackType
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from nispcodec.core.progress import Listener, Progress

PLAIN_INTERVAL = 5.0


def encode_progress(quiet: bool) -> AbstractContextManager[Listener]:
    """Bars on a terminal, a line every few seconds elsewhere, nothing when quiet."""
    from nispcodec.core.progress import silent

    if quiet:
        return nullcontext(silent)
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

    def __call__(self, update: Progress) -> None:
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
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Rows

        self._rows = Rows(
            TextColumn("{task.description}", markup=False),
            BarColumn(bar_width=10),
            TextColumn("{task.fields[text]}", markup=False),
            console=Console(stderr=True),
        )
        self._tasks: dict[str, int] = {}

    def __enter__(self) -> Listener:
        self._rows.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._rows.stop()

    def __call__(self, update: Progress) -> None:
        """Move the bar of the update's network; a note stays above the bars."""
        from rich.progress import TaskID

        if update.note:
            self._rows.console.print(described(update), markup=False)
        if update.network not in self._tasks:
            self._tasks[update.network] = self._rows.add_task("", total=None, text="")
        self._rows.update(
            TaskID(self._tasks[update.network]),
            description=_head(update),
            total=update.steps or None,
            completed=update.step,
            text=" · ".join(_facts(update)),
        )


def described(update: Progress) -> str:
    """One plain line: `uv fit: 100/2000, loss 1.0e-03, held-out 3.1e-04, 12 s left`."""
    facts = ", ".join([*_facts(update), *([update.note] if update.note else [])])
    return f"{_head(update)}: {facts}" if facts else _head(update)


def _head(update: Progress) -> str:
    return f"{update.network} {update.stage}".strip()


def _facts(update: Progress) -> list[str]:
    known = {
        "{}": f"{update.step}/{update.steps}" if update.steps else None,
        "loss {}": _number(update.loss),
        "held-out {}": _number(update.error),
        "{} left": None if isnan(update.seconds_left) else duration(update.seconds_left),
    }
    return [text.format(value) for text, value in known.items() if value]


def _number(value: float) -> str | None:
    return None if isnan(value) else f"{value:.1e}"


def duration(seconds: float) -> str:
    """`8 s`, `1 min 20 s`."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"
