"""`.nisp` against the best of other codecs at equal error, from what other commands have measured.

    python -m benchmarks.headline.main_job --assets ../shared/assets
    python -m benchmarks.headline.duel

The rivals' points are those that `python -m benchmarks.rate_distortion.rivals` has measured. Their
bytes are the fewest of all settings whose mean distance is no larger than ours, and of those whose
mean UV error is no larger either; and where the front of the latter, straight between settings in
logarithms, has our distance. Their color is the best of all settings with no more bytes. Where the
main job ran with several seeds, numbers are means over them, `seeds` how far they went apart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from benchmarks.headline.main_job import RESULTS as MAIN_JOB
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import Record, read_result, write_result
from benchmarks.measuring.target import Asked, Target
from benchmarks.rate_distortion.rows import Row, from_csv, pairs, row
from benchmarks.rate_distortion.summary import OURS, bytes_between, duels, rivals

PRECISE = ("spot", "food_apple_01", "chess_king", "tea_set_01")
DEMANDS = ("distance", "distance and uv")
BETWEEN = "between settings"
POINTS = Path("benchmarks/results/rivals.csv")
RESULTS = Path("benchmarks/results/duel.json")

TARGETS = [
    Target("bytes, ours / theirs, four", ("means", BETWEEN, "four"), 0.38),
    Target("bytes, ours / theirs, all", ("means", BETWEEN, "all"), 0.5),
    Target("bytes, ours / theirs, worst", ("means", BETWEEN, "worst"), 1.03),
    Target("color above the rival's, mean, dB", ("color", "mean"), 2, at_least=True),
    Target("color above the rival's, worst, dB", ("color", "worst"), 0, at_least=True),
]

Duel = dict[str, Any]
Mean = Callable[[Sequence[float]], float]


def geometric_mean(values: Sequence[float]) -> float:
    """The geometric mean of numbers above 0."""
    return float(np.exp(np.mean(np.log(values))))


def arithmetic_mean(values: Sequence[float]) -> float:
    """The mean of numbers."""
    return float(np.mean(values))


def our_rows(records: Mapping[str, Any]) -> list[Row]:
    """The main job's results as rows."""
    return [
        row(
            {
                "asset": name,
                "codec": OURS,
                "setting": {"preset": record["preset"]},
                "bytes": record["bytes"]["geometry_uv"],
                "metrics": record["metrics"],
            }
        )
        for name, record in records.items()
    ]


def duel(rows: Sequence[Row], asset: str) -> Duel:
    """Our bytes and errors, the rivals' bytes for each demand, our share of them; and colors."""
    (found,) = duels(rows, asset)
    ours = next(each for each in rows if each["asset"] == asset and each["codec"] == OURS)
    theirs = rivals(rows, asset, "distance")
    sizes = {name: found["rival_bytes"][name] for name in DEMANDS} | {
        BETWEEN: between(theirs, ours)
    }
    shares = {name: found["bytes"] / size if size else None for name, size in sizes.items()}
    errors = {name: ours[name] for name in ("distance", "uv", "uv_median", "color_psnr")}
    best = best_color(theirs, ours["bytes"])
    above = None if best is None else ours["color_psnr"] - best
    return {
        "bytes": found["bytes"],
        **errors,
        "rival_bytes": sizes,
        "share": shares,
        "rival_color_psnr": best,
        "color_above": above,
    }


def over_seeds(found: Sequence[Duel]) -> Duel:
    """One asset's duels, one a seed, as one: means, of shares geometric; None where one has none.

    `seeds` has their number, and the least and largest share and color.
    """
    merged: Duel = merge(found)
    merged["seeds"] = {
        "count": len(found),
        "share": extremes([each["share"][BETWEEN] for each in found]),
        "color_above": extremes([each["color_above"] for each in found]),
    }
    return merged


def merge(found: Sequence[Any], mean: Mean = arithmetic_mean) -> Any:
    """Records of the same keys as one, with the means of their numbers; sizes stay whole."""
    first = found[0]
    if isinstance(first, Mapping):
        return {
            name: merge([e[name] for e in found], geometric_mean if name == "share" else mean)
            for name in first
        }
    if any(each is None for each in found):
        return None
    return round(mean(found)) if isinstance(first, int) else mean(found)


def extremes(values: Sequence[float | None]) -> list[float] | None:
    """The least and the largest, or None where one is missing."""
    known = [value for value in values if value is not None]
    return [min(known), max(known)] if len(known) == len(values) else None


def between(theirs: Sequence[Row], ours: Row) -> int | None:
    """Bytes where the front of the settings with no larger UV error has our distance."""
    good = [each for each in theirs if each["uv"] is not None and each["uv"] <= ours["uv"]]
    return bytes_between(pairs(good, "distance"), ours["distance"])


def best_color(theirs: Sequence[Row], size: int) -> float | None:
    """PSNR of the base color in dB, the best of all settings of so many bytes."""
    small = (each["color_psnr"] for each in theirs if each["bytes"] <= size)
    return max((color for color in small if color is not None), default=None)


def mean_share(table: Mapping[str, Duel], assets: Sequence[str], demand: str) -> float | None:
    """Geometric mean over the assets where the rival has a setting as good."""
    shares = [table[name]["share"][demand] for name in assets if name in table]
    return over([share for share in shares if share is not None], geometric_mean)


def over(values: Sequence[float], mean: Mean) -> float | None:
    """A mean, or None of nothing."""
    return mean(values) if values else None


def summarized(table: Mapping[str, Duel]) -> Record:
    """Means of our share for each demand, the worst of them, and what our colors are above."""
    means = {
        demand: {
            "four": mean_share(table, PRECISE, demand),
            "all": mean_share(table, list(table), demand),
            "worst": over([s for e in table.values() if (s := e["share"][demand])], max),
        }
        for demand in (*DEMANDS, BETWEEN)
    }
    above = [each["color_above"] for each in table.values() if each["color_above"] is not None]
    color = {"mean": over(above, arithmetic_mean), "worst": over(above, min)}
    return {"means": means, "color": color}


def asked(results: Record) -> Iterator[Asked]:
    """The targets of the means in a result file."""
    yield from (Asked("all assets", target, results) for target in TARGETS)


@click.command()
@click.option("--points", type=click.Path(path_type=Path), default=POINTS, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(points: Path, output: Path) -> None:
    """Print the table and write it as JSON."""
    theirs, measured = from_csv(points.read_text(encoding="utf-8")), read_result(MAIN_JOB)
    by_seed = [measured["assets"], *measured.get("seeds", {}).values()]
    table = {
        name: over_seeds(
            [
                duel([*theirs, *our_rows({name: records[name]})], name)
                for records in by_seed
                if name in records
            ]
        )
        for name in measured["assets"]
    }
    results = {"commit": commit(), "assets": table, **summarized(table)}
    for name, found in table.items():
        click.echo(f"{name:<24}{found['bytes']:>8,}  {found['rival_bytes']}  {found['share']}")
        click.echo(f"{'':<24}color {found['color_psnr']}, rival {found['rival_color_psnr']}")
    click.echo(f"geometric means {results['means']}, color above {results['color']}")
    write_result(output, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
