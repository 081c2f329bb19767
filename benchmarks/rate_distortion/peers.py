"""The line to beat: what simplify + Draco reaches on each asset, at every size.

    python -m benchmarks.rate_distortion.peers -o benchmarks/results/peers.json

Reads the points that `python -m benchmarks --codec simplified_draco` has measured. Errors are in
the normalized frame, the larger of both directions, outer samples only.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from benchmarks.rate_distortion.hull import lower_hull
from benchmarks.rate_distortion.rows import ERRORS, Row, curve, pairs, row
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.summary import LEVELS, RIVAL, fixed

SHOWN = ("setting", "faces", "bytes", "distance", "distance_p99", "uv", "uv_median", "color_psnr")


def hull(rows: Sequence[Row], asset: str, error: str) -> list[Row]:
    """The rival's points on the lower hull of bytes against one error."""
    points = curve(rows, asset, RIVAL, error)
    chosen = [points[index] for index in lower_hull(pairs(points, error))]
    return [{name: point[name] for name in SHOWN} for point in chosen]


def lines(rows: Sequence[Row], asset: str) -> dict[str, Any]:
    """Of one asset: the hull of each error, and the fewest bytes within fixed errors."""
    reached = fixed(rows, asset, [RIVAL])
    return {
        "hull": {error: hull(rows, asset, error) for error in ERRORS},
        "bytes_at": {
            error: {level: sizes[RIVAL] for level, sizes in levels.items()}
            for error, levels in reached.items()
        },
    }


@click.command()
@click.option("--points", type=click.Path(path_type=Path), default="build/bench/points")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True)
def main(points: Path, output: Path) -> None:
    """Write the hulls as JSON and print the bytes at fixed errors."""
    rows = [row(record) for record in Store(points).records() if record["codec"] == RIVAL]
    table = {asset: lines(rows, asset) for asset in sorted({row["asset"] for row in rows})}
    for error in LEVELS:
        click.echo(f"fewest bytes for {ERRORS[error]} of at most")
        for asset, found in table.items():
            cells = [f"{level}: {size}" for level, size in found["bytes_at"][error].items()]
            click.echo(f"  {asset:<18}" + "  ".join(cells))
    write_result(output, {"commit": commit(), "assets": table})


if __name__ == "__main__":
    main()
