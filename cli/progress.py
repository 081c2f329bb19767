"""What the user sees while something takes long: bars on a terminal, plain lines elsewhere."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeVar

import click

from .choices import Named
from .errors import warn

if TYPE_CHECKING:
    from nispcodec.core.progress import Listener

Command = TypeVar("Command", bound=Callable[..., Any])

KINDS = ("auto", "none", "bar", "plain")


def progress_options(command: Command) -> Command:
    """`--progress` and its short form `--quiet`."""
    for option in (_quiet, _progress):
        command = option(command)
    return command


def shown(title: str, progress: str, quiet: bool) -> AbstractContextManager[Listener]:
    """A listener that shows what it is told on standard error, as `--progress` says.

    By default bars on a terminal, elsewhere a line each ten percent. Without rich there are lines
    in place of bars. `title` names the work.
    """
    from nispcodec.core.progress import silent

    from .bars import Bars
    from .lines import Lines

    kind = "none" if quiet else _kind(progress)
    if kind == "none":
        return nullcontext(silent)
    return Bars(title, forced=progress == "bar") if kind == "bar" else Lines(title)


def _kind(progress: str) -> str:
    """`none`, `bar` or `plain`."""
    if progress == "auto":
        able = sys.stderr.isatty() and os.environ.get("TERM") != "dumb"
        return "bar" if able and _has_rich() else "plain"
    if progress == "bar" and not _has_rich():
        warn(["--progress bar needs rich, which is not installed: pip install rich"])
        return "plain"
    return progress


def _has_rich() -> bool:
    return find_spec("rich") is not None


_progress = click.option(
    "--progress",
    type=Named(*KINDS),
    default="auto",
    show_default=True,
    help="auto: bars on a terminal, elsewhere a plain line each ten percent.",
)
_quiet = click.option("--quiet", is_flag=True, help="The same as --progress none.")
