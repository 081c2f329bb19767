"""`best` in as many bytes as an older build's `best` took: time, distance and UV error.

    python -m benchmarks.headline.best --old ../old --only spot

OLD is as in `headline.encode_time`, whose results say how long the older build's `balanced` takes.
Both files are judged by the metrics of this tree. Results are kept encode by encode.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import geometric_mean

import click

from benchmarks.assets.source import Source
from benchmarks.headline.encode_time import RESULTS as TIMES
from benchmarks.headline.encode_time import chosen
from benchmarks.headline.encode_time_table import typical, values
from benchmarks.headline.encode_time_turn import errors
from benchmarks.measuring.build import HERE, Build, build_at
from benchmarks.measuring.machine import machine, versions
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record, read_result, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target

RESULTS = Path("benchmarks/results/best.json")
TARGETS = [
    Target("distance, new / old", ("means", "distance"), 1.0),
    Target("median UV error, new / old", ("means", "uv_median"), 1.0),
    Target("time / old time of `balanced`", ("means", "seconds"), 1.0),
]


def asked(results: Record) -> Iterator[Asked]:
    """The targets: geometric means over the assets."""
    found = {name: ratios(each) for name, each in results["assets"].items() if "new" in each}
    if found:
        means = {
            what: geometric_mean([each[what] for each in found.values()])
            for what in ("bytes", "distance", "uv_median", "seconds")
        }
        yield from (Asked("best", target, {"means": means}) for target in TARGETS)


def ratios(record: Record) -> dict[str, float]:
    """What an asset's new `best` has for each of the old one's; its time for that of `balanced`."""
    new, old = record["new"], record["old"]
    errors = {what: new["errors"][what] / old["errors"][what] for what in ("distance", "uv_median")}
    seconds = new["seconds"] / record["balanced_seconds"]
    return {"bytes": new["bytes"] / old["bytes"], "seconds": seconds, **errors}


def measured(build: Build, source: Source, *settings: str) -> Record:
    """Time, bytes and errors of one encode with `best`."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.nisp"
        files = [str(source.path.resolve()), "-o", str(model)]
        command = [*build.command, "encode", *files, "--preset", "best", *settings, "--json"]
        encode = run(command, model.parent, build.environment)
        return {
            "seconds": encode.seconds,
            "cpu_seconds": encode.cpu_seconds,
            "bytes": json.loads(encode.stdout)["bytes"]["geometry_uv"],
            "errors": errors(build, model, source),
        }


def work(found: Mapping[str, Path], builds: Mapping[str, Build], output: Path, only: str) -> Record:
    """Measure what is missing, of both builds or one -> all results."""
    results: Record = {"assets": {}} | result_so_far(output)
    header = {"commit": builds["new"].name, "old_commit": builds["old"].name}
    results |= header | {"machine": machine(), "versions": versions()}
    runs = read_result(TIMES)["runs"]
    for name, path in found.items():
        record, source = results["assets"].setdefault(name, {}), Source(path)
        if "old" not in record:
            record["old"] = measured(builds["old"], source)
            write_result(output, results)
        if only != "old" and "new" not in record:
            size = str(record["old"]["bytes"])
            record["new"] = measured(builds["new"], source, "--target-size", size)
            record["balanced_seconds"] = typical(values(runs, name, "balanced", "old", "seconds"))
            write_result(output, results)
            click.echo(f"{name}: {ratios(record)}", err=True)
    return results


@click.command()
@click.option("--old", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--assets", type=click.Path(path_type=Path), default="../shared/assets")
@click.option("--only", multiple=True, help="An asset; may be repeated. The eight unless told.")
@click.option("--build", type=click.Choice(["old", "both"]), default="both", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(old: Path, assets: Path, only: tuple[str, ...], build: str, output: Path) -> None:
    """Measure both builds; print asked against measured."""
    builds = {"old": build_at(old), "new": build_at(HERE)}
    results = work(chosen(assets, only), builds, output, build)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
