"""What `nisp batch` says while it runs: a line rewritten on a terminal, elsewhere plain lines."""

from __future__ import annotations

import json
import sys
import time
from math import inf, isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .errors import warn
from .lines import duration

if TYPE_CHECKING:
    from nispcodec.catalogue.job import Result
    from nispcodec.catalogue.tally import Tally

PLAIN_EVERY = 10.0
"""Seconds between two lines, where they stay; on a terminal one is rewritten every second."""
METRICS_EVERY = 5.0
KILO = 1000.0


class Reporter:
    """Tells of a batch on standard error; results as JSON lines on standard output, if wanted.

    every    seconds between two lines of progress, infinite for none
    rewrite  whether a line takes the place of the one before
    """

    def __init__(self, every: float, rewrite: bool, as_json: bool, metrics: Path | None) -> None:
        self.failures = 0
        self._every, self._rewrite = every, rewrite
        self._as_json, self._metrics = as_json, metrics
        self._next_line, self._next_metrics = time.monotonic() + every, 0.0
        self._open = False

    def tick(self, tally: Tally) -> None:
        """Say how far it is, if it is time."""
        now = time.monotonic()
        if now >= self._next_line:
            self._next_line = now + self._every
            self._say(progress_line(tally), stays=not self._rewrite)
        if self._metrics is not None and now >= self._next_metrics:
            self._next_metrics = now + METRICS_EVERY
            _write_metrics(self._metrics, tally)

    def result(self, result: Result) -> None:
        """Say what failed; with --json, everything."""
        record = result.record
        if not record.done:
            self.failures += 1
            tried = f" ({record.tries} tries)" if record.tries > 1 else ""
            self._say(f"nisp: failed: {printable(record.source)}: {printable(record.error)}{tried}")
        if self._as_json:
            click.echo(json.dumps({**json.loads(record.line()), "kept": result.kept}))

    def warn(self, said: str) -> None:
        """Say something that is no failure."""
        self._clear()
        warn([printable(said)])

    def end(self, tally: Tally, stopped: str) -> None:
        """Say what came, and what is to be done."""
        if self._metrics is not None:
            _write_metrics(self._metrics, tally)
        self._clear()
        if stopped:
            self._say(f"nisp: stopped: {printable(stopped)}: make room and run it again")
        if self._as_json:
            click.echo(json.dumps({"end": {**tally.facts, "stopped": stopped}}))
        else:
            click.echo(end_line(tally, self.failures))

    def merged(self, done: int, failed: int) -> None:
        """Say what a merge came to."""
        if self._as_json:
            click.echo(json.dumps({"end": {"done": done, "failed": failed}}))
        else:
            click.echo(f"{done:,} done, {failed:,} failed")

    def _say(self, line: str, stays: bool = True) -> None:
        self._clear()
        click.echo(line, err=True, nl=stays)
        self._open = not stays

    def _clear(self) -> None:
        """Take back a line that does not stay."""
        if self._open:
            click.echo("\r\x1b[K", err=True, nl=False, color=True)
        self._open = False


def batch_reporter(quiet: bool, as_json: bool, metrics: Path | None) -> Reporter:
    """The reporter for where standard error goes."""
    rewrite = sys.stderr.isatty()
    every = inf if quiet else 1.0 if rewrite else PLAIN_EVERY
    return Reporter(every, rewrite, as_json, metrics)


def progress_line(tally: Tally) -> str:
    """`12 of 64 done, 1 failed, 2 running, 310 an hour, about 9 min 50 s left, 4.1 MB saved`."""
    parts = [f"{tally.done + tally.kept:,} of {tally.total:,} done"]
    parts += [f"{tally.failed:,} failed"] if tally.failed else []
    parts += [f"{tally.running:,} running"]
    if tally.hourly and isfinite(tally.seconds_left):
        parts += [f"{tally.hourly:,.0f} an hour", f"about {duration(tally.seconds_left)} left"]
    return ", ".join([*parts, f"{size(tally.in_bytes - tally.out_bytes)} saved"])


def end_line(tally: Tally, failures: int) -> str:
    """What came, in one line."""
    kept = f" ({tally.kept:,} of an earlier run)" if tally.kept else ""
    return (
        f"{tally.done + tally.kept:,} done{kept}, {failures:,} failed, {tally.left:,} not begun: "
        f"{size(tally.out_bytes)} from {size(tally.in_bytes)} in {duration(tally.seconds)}"
    )


def size(count: float) -> str:
    """`4.1 MB`."""
    for unit in ("B", "kB", "MB", "GB"):
        if abs(count) < KILO:
            return f"{count:.0f} B" if unit == "B" else f"{count:.1f} {unit}"
        count /= KILO
    return f"{count:.1f} TB"


def printable(text: str) -> str:
    """The text with what no terminal shows written out: names need not be UTF-8."""
    return text.encode("utf-8", "backslashreplace").decode()


def _write_metrics(path: Path, tally: Tally) -> None:
    from nispcodec.catalogue.tally import open_metrics
    from nispcodec.core.atomic_write import write_atomic

    write_atomic(path, open_metrics(tally).encode())
