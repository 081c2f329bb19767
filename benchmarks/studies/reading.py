"""How long mesh files take to read: this build against another checkout of the project.

    python -m benchmarks.studies.reading --old OLD --assets ../shared/assets [ASSET.obj ...]

Each asset is read by both builds by turns, each time in a process of its own that reads it twice:
once for what is imported on the way, once timed. Seconds are of the processor, of the quickest
round. Without names, the assets are those that a time was asked for.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from benchmarks.measuring.build import HERE
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each

RESULTS = Path("benchmarks/results/reading.json")
ASKED_FOR = ("flight_helmet/flight_helmet.obj", "chess_king/chess_king.obj")
RATIO = Target("seconds of the processor, new / old", ("ratio",), 1.1)
# Former builds have the reader in another module.
READ = """
import sys, time
try:
    from nispcodec.io.load import load_mesh
except ImportError:
    from nispcodec.mesh.load import load_mesh
load_mesh(sys.argv[1])
started = time.process_time()
load_mesh(sys.argv[1])
print(time.process_time() - started)
"""


def seconds(build: Path, asset: Path) -> float:
    """Seconds of the processor in which a checkout reads a file."""
    environment = os.environ | {"PYTHONPATH": str(build.resolve())}
    with tempfile.TemporaryDirectory() as scratch:
        command: list[str | Path] = [sys.executable, "-c", READ, asset.resolve()]
        return float(run(command, Path(scratch), environment).stdout)


def by_turns(old: Path, asset: Path, rounds: int) -> Record:
    """Seconds of both builds, and their ratio."""
    builds = {"old": old, "new": HERE}
    read = [{name: seconds(build, asset) for name, build in builds.items()} for _ in range(rounds)]
    best = {name: min(each[name] for each in read) for name in builds}
    return {**best, "ratio": best["new"] / best["old"]}


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda asset: [RATIO])


@click.command()
@click.argument("names", nargs=-1)
@click.option("--old", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--rounds", default=7, show_default=True)
def main(names: Sequence[str], old: Path, assets: Path, rounds: int) -> None:
    """Write the seconds of each asset, and print what was asked against what was measured."""
    found = {Path(name).stem: by_turns(old, assets / name, rounds) for name in names or ASKED_FOR}
    where = {"commit": commit(), "old": commit(old), "machine": machine(), "versions": versions()}
    results = where | {"assets": found}
    write_result(RESULTS, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
