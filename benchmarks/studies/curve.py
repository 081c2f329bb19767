"""What more bytes buy: files of 1 to 4 times the default's bytes, beside the rivals' front.

    python -m benchmarks.studies.curve --assets ../shared/assets [--only spot]

Files are made by the public option `target_size`; the default's bytes and distance are those of
`main_job.json`, the rivals' points those of `rivals.csv`. Errors are those of the mesh that the
written bytes decode to. Between settings the rivals' front is straight in logarithms. Results are
kept point by point: an interrupted run goes on where it stopped.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import click
import numpy as np

from benchmarks.assets.source import Source, sources
from benchmarks.headline.duel import POINTS, geometric_mean
from benchmarks.headline.main_job import RESULTS as MAIN_JOB
from benchmarks.measuring.machine import machine, versions
from benchmarks.measuring.result_file import Record, read_result, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target
from benchmarks.rate_distortion.bjontegaard import front
from benchmarks.rate_distortion.point import measured
from benchmarks.rate_distortion.rows import Row, from_csv, pairs, row
from benchmarks.rate_distortion.summary import rivals
from nispcodec.format import unpack

RESULTS = Path("benchmarks/results/curve.json")
ASSETS = (
    "boombox", "chess_king", "exploding_barrel", "flight_helmet", "food_apple_01", "gz_polaris",
    "spot", "tea_set_01",
)  # fmt: skip
MULTIPLES = (1, 2, 3, 4)
ASKED_OF_THE_MEAN = 3
ASKED_AGAINST_RIVALS = (2, 4)
KEPT = ("bytes", "faces", "distance", "distance_p99", "uv", "uv_median", "color_psnr")

Curve = dict[str, Any]


def targets_of_asset(found: Curve) -> Iterator[Target]:
    """What is asked of the curve of one asset, as far as it was measured."""
    for times in found["points"]:
        yield Target(f"bytes / asked, {times} x", ("points", times, "bytes_of_asked"), 1.0)
    for times in map(str, ASKED_AGAINST_RIVALS):
        theirs = found["rival_fall"][times]
        yield Target(f"distance / default's, {times} x", ("fall", times), theirs)


def asked(results: Record) -> Iterator[Asked]:
    """The targets of a result file: of the mean over the assets, then of each."""
    times = str(ASKED_OF_THE_MEAN)
    mean = Target(f"distance / default's, {times} x, mean", ("mean_fall", times), 0.6)
    yield Asked("all assets", mean, results)
    for name, found in results["assets"].items():
        yield from (Asked(name, target, found) for target in targets_of_asset(found))


def point(source: Source, preset: str, size: int) -> Record:
    """A file of so many bytes at most: what it is, and its errors."""
    record, data = measured(source, "nisp", {"preset": preset, "target_size": size})
    if "failure" in record:
        return {"commit": record["commit"], "asked": size, "failure": record["failure"]}
    document = unpack(data)
    forms = {"networks": document.field is not None, "triangles": bool(document.meshes)}
    flat = row(record)
    return {
        "commit": record["commit"],
        "asked": size,
        "bytes_of_asked": flat["bytes"] / size,
        "held_as": " and ".join(name for name, there in forms.items() if there),
        **{name: flat[name] for name in KEPT},
        "encode_cpu_seconds": flat["encode_cpu_seconds"],
    }


def compared(default: Record, points: Mapping[str, Record], theirs: Sequence[Row]) -> Curve:
    """The default's file, the points, and how the distance falls: ours, and the rivals'."""
    size, distance = default["bytes"]["geometry_uv"], default["metrics"]["geometry"]["larger"]
    rival = {str(times): rival_distance(theirs, times * size) for times in MULTIPLES}
    good = {times: each for times, each in points.items() if "failure" not in each}
    return {
        "default": {
            "bytes": size,
            "distance": distance["mean"],
            "uv": default["metrics"]["uv"]["larger"]["mean"],
            "uv_median": default["metrics"]["uv"]["larger"]["median"],
        },
        "points": dict(points),
        "rival_distance": rival,
        "fall": {times: each["distance"] / distance["mean"] for times, each in good.items()},
        "rival_fall": {times: each / rival["1"] for times, each in rival.items()},
        "of_rival": {times: each["distance"] / rival[times] for times, each in good.items()},
    }


def rival_distance(theirs: Sequence[Row], size: float) -> float:
    """The mean distance of the rivals' front at so many bytes; beyond its ends, that of the end."""
    sizes, errors = np.log(front(pairs(theirs, "distance"))).T
    return float(np.exp(np.interp(np.log(size), sizes, errors)))


def means(curves: Mapping[str, Curve], what: str) -> dict[str, float]:
    """By multiple the geometric mean over the assets that were measured there."""
    found = {
        str(times): [each[what][str(times)] for each in curves.values() if str(times) in each[what]]
        for times in MULTIPLES
    }
    return {times: geometric_mean(values) for times, values in found.items() if values}


def results_of(curves: Mapping[str, Curve]) -> Record:
    """Everything that is written."""
    return {
        "machine": machine(),
        "versions": versions(),
        "mean_fall": means(curves, "fall"),
        "mean_of_rival": means(curves, "of_rival"),
        "assets": dict(curves),
    }


def line(name: str, times: str, found: Curve) -> str:
    """One point as text."""
    each = found["points"][times]
    if "failure" in each:
        return f"{name:<18}{times} x  FAILED: {each['failure']}"
    return (
        f"{name:<18}{times} x{each['bytes']:>8,} of {each['asked']:>8,}  {each['held_as']:<24}"
        f"distance {each['distance']:.2e}, {found['fall'][times]:.2f} of the default's (rivals "
        f"{found['rival_fall'][times]:.2f}), {found['of_rival'][times]:.2f} of the rivals'; "
        f"UV mean {each['uv']:.2e}, median {each['uv_median']:.2e}"
    )


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset; may be repeated.")
@click.option("--again", is_flag=True, help="Measure points that have a result already.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(assets: Path, only: tuple[str, ...], again: bool, output: Path) -> None:
    """Measure the curve of each asset and print asked against measured."""
    curves = result_so_far(output).get("assets", {})
    defaults, rows = read_result(MAIN_JOB)["assets"], from_csv(POINTS.read_text(encoding="utf-8"))
    for source in (each for each in sources(assets) if each.name in (only or ASSETS)):
        name, default = source.name, defaults[source.name]
        points = {} if again else dict(curves.get(name, {}).get("points", {}))
        for times in map(str, MULTIPLES):
            if times in points and "failure" not in points[times]:
                continue
            size = int(times) * default["bytes"]["geometry_uv"]
            points[times] = point(source, default["preset"], size)
            theirs = rivals(rows, name, "distance")
            curves[name] = compared(default, points, theirs)
            write_result(output, results_of(curves))
            click.echo(line(name, times, curves[name]))
    for each in asked(results_of(curves)):
        click.echo(each.line())


if __name__ == "__main__":
    main()
