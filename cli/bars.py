"""Progress as bars on a terminal: one for the whole, one a network. Needs rich."""

from __future__ import annotations

from math import isnan
from types import TracebackType
from typing import TYPE_CHECKING

from .lines import Whole, duration, facts, head, noted, percent

if TYPE_CHECKING:
    from rich.progress import TaskID

    from nispcodec.core.progress import Listener, Progress


class Bars:
    """A bar for the whole and one for each network, redrawn in place.

    `forced` draws them where there is no terminal, too.
    """

    def __init__(self, title: str, forced: bool = False) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, TextColumn
        from rich.progress import Progress as Rows

        self._title = title
        self._whole = Whole()
        self._rows = Rows(
            TextColumn("{task.description}", markup=False),
            BarColumn(bar_width=20),
            TextColumn("{task.fields[text]}", markup=False),
            console=Console(stderr=True, force_terminal=True if forced else None),
        )
        self._total = self._rows.add_task(title, total=1.0, text="")
        self._tasks: dict[str, TaskID] = {}

    def __enter__(self) -> Listener:
        self._rows.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            text = f"{percent(1.0)} · {duration(self._whole.seconds)}"
            self._rows.update(self._total, completed=1.0, text=text)
        self._rows.stop()

    def __call__(self, update: Progress) -> None:
        """Move the bars of the whole and of the update's network; a note stays above them."""
        if update.note:
            self._rows.console.print(noted(update), markup=False)
        if update.network:
            self._move(update)
        self._move_whole(update)

    def _move(self, update: Progress) -> None:
        if update.network not in self._tasks:
            self._tasks[update.network] = self._rows.add_task("", total=None, text="")
        self._rows.update(
            self._tasks[update.network],
            description=head(update),
            total=update.steps or None,
            completed=update.step,
            text=" · ".join(facts(update)),
        )

    def _move_whole(self, update: Progress) -> None:
        self._whole.hear(update)
        left = self._whole.seconds_left
        told = [percent(self._whole.share)]
        told += [] if update.network else [update.stage]
        told += [] if isnan(left) else [f"about {duration(left)} left"]
        self._rows.update(self._total, completed=self._whole.share, text=" · ".join(told))
