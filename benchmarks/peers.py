"""The line to beat: what simplify + Draco reaches on each asset, at every size.

    python -m benchmarks.peers --points build/bench/points -o benchmarks/results/peers.json

Reads the points that `python -m benchmarks --codec simplified_draco` has measured. Errors are means
in the normalised frame, the larger of both directions, outer samples only.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchmarks.hull import lower_hull
from benchmarks.machine import commit
from benchmarks.store import Record, Store
from nispcodec.output import write_atomic

CODEC = "simplified_draco"
LEVELS = {"geometry": (2e-3, 1.5e-3, 1e-3, 7e-4, 5e-4, 3.5e-4), "uv": (1e-2, 5e-3, 2e-3, 1e-3)}


def summary(record: Record) -> Record:
    """The numbers that curves are drawn of."""
    metrics = record["metrics"]
    return {
        "setting": record["setting"],
        "faces": record["faces"],
        "bytes": record["bytes"],
        "geometry": metrics["geometry"]["larger"]["mean"],
        "geometry_p99": metrics["geometry"]["larger"]["p99"],
        "uv": metrics["uv"]["larger"]["mean"],
        "uv_median": metrics["uv"]["larger"]["median"],
        "color_psnr": metrics["color"]["psnr"],
    }


def hull_of(points: list[Record], error: str) -> list[Record]:
    """The points on the lower hull of bytes against one error."""
    return [points[index] for index in lower_hull([(p["bytes"], p[error]) for p in points])]


def bytes_at(points: list[Record], error: str, level: float) -> int | None:
    """The fewest bytes of any point with at most this error."""
    return min((point["bytes"] for point in points if point[error] <= level), default=None)


def curves(points: list[Record]) -> dict[str, Any]:
    """Of one asset: the hulls of both errors, and bytes at fixed errors."""
    return {
        "hull": {error: hull_of(points, error) for error in ("geometry", "uv", "uv_median")},
        "bytes_at": {
            error: {f"{level:g}": bytes_at(points, error, level) for level in levels}
            for error, levels in LEVELS.items()
        },
    }


@click.command()
@click.option("--points", type=click.Path(path_type=Path), default="build/bench/points")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True)
def main(points: Path, output: Path) -> None:
    """Write the hulls as JSON and print bytes at fixed errors."""
    records = [r for r in Store(points).records() if r["codec"] == CODEC and "metrics" in r]
    assets = sorted({record["asset"] for record in records})
    table = {a: curves([summary(r) for r in records if r["asset"] == a]) for a in assets}
    for asset, found in table.items():
        cells = [f"{level}: {size}" for level, size in found["bytes_at"]["geometry"].items()]
        click.echo(f"{asset:<18}" + "  ".join(cells))
    write_atomic(output, json.dumps({"commit": commit(), "assets": table}, indent=1).encode())


if __name__ == "__main__":
    main()
