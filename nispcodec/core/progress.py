"""Progress of a long encode, told to whoever waits for it."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from nispcodec.core.errors import NispWarning

_PACKAGE = __name__.split(".")[0]


@dataclass(frozen=True)
class Progress:
    """One moment of an encode.

    network       "sdf", "chart" or "uv"; "" for a stage of the whole encode
    stage         what is being done, in a word or two
    step, steps   how far it is; no `steps` where nobody knows how many there will be
    loss          training loss, smoothed; NaN, as the next two, where nothing is known
    error         held-out error: sdf mean distance (normalized), chart share of wrong labels,
                  uv mean distance in the network's [0, 1]^2 given the true chart
    seconds_left  estimate for this network
    note          something worth a line of its own, such as a retry
    warning       something about the asset or its fit that its owner should know
    part_errors   told once, at the end: of each part of what was made the mean distance of its
                  surface to the original's (normalized frame), and the mean UV error
    overall       share of the whole work that is done, 0 to 1, never less than told before;
                  NaN when it is not known
    """

    network: str = ""
    stage: str = ""
    step: int = 0
    steps: int = 0
    loss: float = float("nan")
    error: float = float("nan")
    seconds_left: float = float("nan")
    note: str = ""
    warning: str = ""
    part_errors: tuple[tuple[float, float], ...] = ()
    overall: float = float("nan")


Listener = Callable[[Progress], None]


def silent(_: Progress) -> None:
    """A listener that ignores all progress."""


def warning_listener(update: Progress) -> None:
    """A listener for those who gave none: warnings go Python's way, the rest is ignored."""
    if update.warning:
        warn([update.warning])


def warn(sentences: Iterable[str]) -> None:
    """Warn of each by Python's `warnings`, as from the line that called this package."""
    level, frame = 1, sys._getframe()
    while frame.f_back and frame.f_globals.get("__name__", "").split(".")[0] == _PACKAGE:
        level, frame = level + 1, frame.f_back
    for each in sentences:
        warnings.warn(each, NispWarning, stacklevel=level)
