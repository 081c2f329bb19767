"""What the runs of two builds say: ratios new / old, by asset and over all assets."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import geometric_mean, median

from benchmarks.measuring.result_file import Record

BUILDS = ("old", "new")
MEASURES = {
    "seconds": "time",
    "cpu_seconds": "processor time",
    "peak_bytes": "peak memory",
    "bytes": "bytes",
    "distance": "distance",
    "uv_median": "UV median",
    "uv_mean": "UV mean",
    "color": "color error",
}
"""What is compared and what the table calls it; less is better in all."""

Place = tuple[int, int]
"""Seed and round."""

Values = dict[Place, float]
"""What was measured of one asset and build."""


@dataclass(frozen=True)
class Ratio:
    """New / old, of typical values; and of every pair that was measured by turns."""

    value: float
    pairs: Values

    def __str__(self) -> str:
        least, most = min(self.pairs.values()), max(self.pairs.values())
        spread = f" ({least:.2f} to {most:.2f})" if least < most else ""
        return f"{self.value:.2f}{spread}"


def presets(runs: Sequence[Record]) -> list[str]:
    """In the order in which they were measured."""
    return list(dict.fromkeys(each["preset"] for each in runs))


def assets(runs: Sequence[Record], preset: str) -> list[str]:
    """Those with runs of a preset, by name."""
    return sorted({each["asset"] for each in runs if each["preset"] == preset})


def values(runs: Sequence[Record], asset: str, preset: str, build: str, measure: str) -> Values:
    """What was measured of one asset; nothing of failures, zeros and what the asset has not."""
    wanted = {"asset": asset, "preset": preset, "build": build}
    alike = [each for each in runs if wanted.items() <= each.items() and "failure" not in each]
    found = {(each["seed"], each["round"]): each | each["errors"] for each in alike}
    return {place: each[measure] for place, each in found.items() if each.get(measure)}


def typical(found: Values) -> float | None:
    """The median over the rounds of a seed, and of these the geometric mean over the seeds.

    The median leaves out what others did to the machine; the mean leaves out no seed, as a fit
    that goes wrong is ours.
    """
    seeds: dict[int, list[float]] = defaultdict(list)
    for (seed, _), value in found.items():
        seeds[seed].append(value)
    return geometric_mean([median(each) for each in seeds.values()]) if seeds else None


def ratio(runs: Sequence[Record], asset: str, preset: str, measure: str) -> Ratio | None:
    """New / old of one asset, from the seeds and rounds that both have; None without any."""
    old, new = (values(runs, asset, preset, build, measure) for build in BUILDS)
    both = old.keys() & new.keys()
    before, after = (typical({place: each[place] for place in both}) for each in (old, new))
    if before is None or after is None:
        return None
    return Ratio(after / before, {place: new[place] / old[place] for place in both})


def mean(ratios: Sequence[Ratio]) -> Ratio:
    """The geometric mean over assets; pairs of the seeds and rounds that all of them have."""
    common = set.intersection(*(set(each.pairs) for each in ratios))
    value = geometric_mean([each.value for each in ratios])
    pairs = {place: geometric_mean([each.pairs[place] for each in ratios]) for place in common}
    return Ratio(value, pairs or {(0, 0): value})


def by_measure(runs: Sequence[Record], preset: str) -> dict[str, dict[str, Ratio]]:
    """Measure -> asset -> its ratio, of what both builds have."""
    found = {
        measure: {name: ratio(runs, name, preset, measure) for name in assets(runs, preset)}
        for measure in MEASURES
    }
    return {
        measure: {name: each for name, each in ratios.items() if each is not None}
        for measure, ratios in found.items()
    }


def summary(runs: Sequence[Record]) -> Record:
    """Preset -> ratios over all assets, the new build's seconds by asset, its largest peak."""
    return {preset: _summary(runs, preset) for preset in presets(runs)}


def _summary(runs: Sequence[Record], preset: str) -> Record:
    ratios = {name: list(each.values()) for name, each in by_measure(runs, preset).items()}
    names = assets(runs, preset)
    peaks = [each for name in names for each in _new(runs, name, preset, "peak_bytes").values()]
    seconds = {name: typical(_new(runs, name, preset, "seconds")) for name in names}
    return {
        "ratios": {
            name: {"mean": mean(each).value, "worst": max(one.value for one in each)}
            for name, each in ratios.items()
            if each
        },
        "new_seconds": seconds,
        "largest_peak_bytes": max(peaks, default=None),
    }


def _new(runs: Sequence[Record], asset: str, preset: str, measure: str) -> Values:
    return values(runs, asset, preset, "new", measure)


def tables(runs: Sequence[Record]) -> str:
    """A Markdown table for each preset, and what failed."""
    parts = ["\n".join(table(runs, preset)) for preset in presets(runs)]
    parts += [_slow_against_usual(runs)] if {"best", "balanced"} <= set(presets(runs)) else []
    failed = [
        "FAILED: {asset} {preset}, seed {seed}, {build}: {failure}".format(**each)
        for each in runs
        if "failure" in each
    ]
    return "\n\n".join([*parts, *failed])


def table(runs: Sequence[Record], preset: str) -> Iterator[str]:
    """Seconds of both builds, then ratios new / old with the least and most of all pairs."""
    alike = [each for each in runs if each["preset"] == preset]
    seeds, rounds = (len({each[name] for each in alike}) for name in ("seed", "round"))
    found = by_measure(runs, preset)
    yield f"{preset}: new / old; seeds: {seeds}, rounds: {rounds}"
    yield ""
    yield f"| asset | old, s | new, s | {' | '.join(MEASURES.values())} |"
    yield "|---" * (3 + len(MEASURES)) + "|"
    for name in assets(runs, preset):
        seconds = [typical(values(runs, name, preset, build, "seconds")) for build in BUILDS]
        cells = [*map(_seconds, seconds), *(str(each.get(name, "–")) for each in found.values())]
        yield f"| {name} | {' | '.join(cells)} |"
    everything = [list(each.values()) for each in found.values()]
    means = [str(mean(each)) if each else "–" for each in everything]
    yield f"| geometric mean | | | {' | '.join(means)} |"
    yield f"| worst | | | {' | '.join(map(_worst, found.values()))} |"


def _worst(ratios: dict[str, Ratio]) -> str:
    if not ratios:
        return "–"
    name = max(ratios, key=lambda each: ratios[each].value)
    return f"{ratios[name].value:.2f} {name}"


def _seconds(value: float | None) -> str:
    return "–" if value is None else f"{value:.1f}"


def _slow_against_usual(runs: Sequence[Record]) -> str:
    """Whether the new `best` fits into the time that the old `balanced` took."""
    pairs = [
        (typical(values(runs, name, "balanced", "old", "seconds")),
         typical(values(runs, name, "best", "new", "seconds")))
        for name in assets(runs, "best")
    ]  # fmt: skip
    shares = [best / usual for usual, best in pairs if usual and best]
    share = geometric_mean(shares) if shares else math.nan
    return f"best of the new build / balanced of the old: {share:.2f} of the time"
