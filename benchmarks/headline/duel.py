"""`.nisp` against simplify + Draco at equal error, from what other commands have measured.

    python -m benchmarks.headline.main_job --assets ../shared/assets
    python -m benchmarks.headline.duel

The rival's points are those that the last `make bench` left in `results/bench.csv`. Its bytes are
the fewest of all its settings whose mean distance is no larger than ours, and of those whose mean
UV error is no larger either.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from benchmarks.headline.main_job import RESULTS as MAIN_JOB
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import Record, read_result, write_result
from benchmarks.measuring.target import Asked, Target
from benchmarks.rate_distortion.rows import Row, from_csv, row
from benchmarks.rate_distortion.summary import OURS, RIVALS, duels

PRECISE = ("spot", "food_apple_01", "chess_king", "tea_set_01")
POINTS = Path("benchmarks/results/bench.csv")
DEMANDS = ("distance", "distance and uv")
RESULTS = Path("benchmarks/results/duel.json")

TARGETS = [
    Target("share of bytes, four", ("distance and uv", "four"), 0.38),
    Target("share of bytes, all", ("distance and uv", "all"), 0.5),
]

Duel = dict[str, Any]


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
    """Our bytes, the rival's for each demand, and our share of them."""
    (found,) = duels(rows, asset)
    rivals = {name: found["rival_bytes"][name] for name in DEMANDS}
    shares = {name: found["bytes"] / size if size else None for name, size in rivals.items()}
    ours = next(each for each in rows if each["asset"] == asset and each["codec"] == OURS)
    errors = {name: ours[name] for name in ("distance", "uv", "uv_median")}
    return {"bytes": found["bytes"], **errors, "rival_bytes": rivals, "share": shares}


def mean_share(table: Mapping[str, Duel], assets: Sequence[str], demand: str) -> float | None:
    """Geometric mean over the assets where the rival has a setting as good."""
    shares = [table[name]["share"][demand] for name in assets if name in table]
    known = [share for share in shares if share is not None]
    return float(np.exp(np.mean(np.log(known)))) if known else None


def asked(results: Record) -> Iterator[Asked]:
    """The targets of the geometric means in a result file."""
    yield from (Asked("geometric means", target, results["means"]) for target in TARGETS)


@click.command()
@click.option("--points", type=click.Path(path_type=Path), default=POINTS, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(points: Path, output: Path) -> None:
    """Print the table and write it as JSON."""
    records = read_result(MAIN_JOB)["assets"]
    everyone = from_csv(points.read_text(encoding="utf-8"))
    rivals = [each for each in everyone if each["codec"] in RIVALS]
    rows = [*rivals, *our_rows(records)]
    table = {name: duel(rows, name) for name in records}
    means = {
        demand: {
            "four": mean_share(table, PRECISE, demand),
            "all": mean_share(table, list(table), demand),
        }
        for demand in DEMANDS
    }
    for name, found in table.items():
        click.echo(f"{name:<18}{found['bytes']:>8,}  {found['rival_bytes']}  {found['share']}")
    click.echo(f"geometric means {means}")
    results = {"commit": commit(), "assets": table, "means": means}
    write_result(output, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
