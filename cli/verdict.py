"""What the numbers of `nisp compare` come to, in a sentence.

The bounds are rules of thumb, no test with viewers. They follow pictures of eight assets seen from
four sides (benchmarks/results/main_job.json): what is "hard to tell apart" there has an SSIM of
0.991 and more, "small differences close up" 0.987 and more, "side by side" 0.96.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

SAME = 1e-9
FAR = 0.05
"""A point so far off, in radii, is more than a rough surface: something is missing or new."""


@dataclass(frozen=True)
class Grade:
    """In words, and the largest numbers that deserve it.

    mean   mean distance, and ...
    p99    ... distance of the worst hundredth, in radii
    color  root mean square difference of base colors, 1 the whole range
    """

    words: str
    mean: float
    p99: float
    color: float


GRADES = (
    Grade("hard to tell apart by eye", 5e-4, 3e-3, 0.02),
    Grade("alike at normal size, small differences close up", 1e-3, 5e-3, 0.06),
    Grade("differences show side by side", 5e-3, 3e-2, 0.12),
    Grade("different at a glance", float("inf"), float("inf"), float("inf")),
)
SIDE_BY_SIDE = 2
"""The best grade where a part is missing or new."""


def verdict(report: Mapping[str, Any]) -> str:
    """One or two sentences on a report of `nispcodec.metrics.compare`."""
    distance, color = report["geometry"]["larger"], _difference(report["color"]["psnr"])
    pieces = report["spurious"]["count"]
    first = next(
        number
        for number, grade in enumerate(GRADES)
        if distance["mean"] <= grade.mean and distance["p99"] <= grade.p99 and color <= grade.color
    )
    off = [_lost(distance["max"]), _floating(pieces)]
    best = SIDE_BY_SIDE if any(off) else 0
    said = f"{_apart(distance)}; {_colored(color)}: {GRADES[max(first, best)].words}."
    return " ".join([said, *(each for each in off if each)])


def bounds() -> str:
    """What the words of a verdict stand for, a line each."""
    lines = [
        f'"{each.words}": up to {_percent(each.mean)} of the radius apart in the mean and '
        f"{_percent(each.p99)} at the worst hundredth, base colors up to {_percent(each.color)}"
        for each in GRADES[:-1]
    ]
    return "\n".join(["The verdict, by rules of thumb:", *(f"  {line}" for line in lines)])


def _difference(psnr: float) -> float:
    """Root mean square difference for a PSNR in dB of peak 1."""
    return float(10 ** (-psnr / 20))


def _apart(distance: Mapping[str, float]) -> str:
    if distance["p99"] < SAME:
        return "The surfaces are the same"
    return (
        f"The surfaces are {_percent(distance['mean'])} of the radius apart in the mean"
        f" and {_percent(distance['p99'])} at the worst hundredth"
    )


def _colored(difference: float) -> str:
    if difference < SAME:
        return "base colors are the same"
    return f"base colors differ by {_percent(difference)} (root mean square)"


def _lost(furthest: float) -> str:
    if furthest <= FAR:
        return ""
    return f"Somewhere they are {_percent(furthest)} apart: look for a part that is lost or new."


def _floating(pieces: int) -> str:
    if not pieces:
        return ""
    return f"{pieces} {'piece floats' if pieces == 1 else 'pieces float'} where nothing should be."


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %"
