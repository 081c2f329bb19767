"""All that a batch does besides encoding: start-up, scan, records, memory of the driver.

    python -m benchmarks.catalogue.bookkeeping [--count 10000] [-o OUT.json]

The encoder is a stub that takes no time. COUNT small assets are done, then found done by a second
run. 64 assets of the sample catalogue show what an asset costs besides its encode: seconds of all
workers, from the first import to the last byte of the page, by the number of assets. Where others
use the machine (`load`), processor seconds tell more.
"""

from __future__ import annotations

import os
import resource
import tempfile
import time
from functools import partial
from pathlib import Path

import click

from benchmarks.catalogue.encoders import stub
from benchmarks.catalogue.samples import write_samples
from benchmarks.measuring.isolated import isolated
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target
from nispcodec.catalogue.batch import Batch
from nispcodec.catalogue.config import BatchConfig
from nispcodec.catalogue.find import find_assets

RESULTS = Path("benchmarks/results/batch_bookkeeping.json")
TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
SAMPLES = 64
FOLDER = 1000
"""Assets in a folder."""
TARGETS = (
    Target("driver's memory, bytes", ("many", "driver_peak_bytes"), 300e6),
    Target("driver, s an asset", ("many", "driver_seconds_per_asset"), 0.005),
    Target("besides its encode, s an asset", ("samples", "seconds_per_asset"), 0.3),
)


def asked(results: Record) -> list[Asked]:
    """The targets of a result file."""
    return [Asked("batch with a stub", target, results) for target in TARGETS]


def ran(source: Path, output: Path, thumbnail: int) -> Record:
    """One batch: wall seconds of scan and all, seconds and memory of the driver."""
    started, cpu = time.monotonic(), time.process_time()
    found = list(find_assets([str(source)]))
    scanned = time.monotonic()
    config = BatchConfig(thumbnail=thumbnail)
    results = list(Batch(str(output), config=config, encode=stub).run(found))
    seconds, mine = time.monotonic() - started, time.process_time() - cpu
    workers = resource.getrusage(resource.RUSAGE_CHILDREN)
    everyone = mine + workers.ru_utime + workers.ru_stime
    count = len(found)
    return {
        "assets": count,
        "done": sum(each.record.done for each in results),
        "kept": sum(each.kept for each in results),
        "jobs": config.jobs_here(),
        "seconds": round(seconds, 2),
        "seconds_per_asset": round(seconds * config.jobs_here() / count, 5),
        "processor_seconds_per_asset": round(everyone / count, 5),
        "load": os.getloadavg()[0],
        "scan_seconds": round(scanned - started, 3),
        "driver_seconds": round(mine, 2),
        "driver_seconds_per_asset": round(mine / count, 6),
        "driver_peak_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }


def many(folder: Path, count: int) -> Path:
    """So many tetrahedra, each a little elsewhere."""
    for number in range(count):
        path = folder / f"{number // FOLDER:03d}" / f"{number:06d}.obj"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"# {number}\n{TRIANGLES}")
    return folder


@click.command()
@click.option("--count", default=10_000, show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(count: int, output: Path) -> None:
    """Measure, each batch with a driver of its own; print asked against measured."""
    results: Record = {"commit": commit(), "machine": machine(), "versions": versions()}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source, samples = many(folder / "many", count), write_samples(folder / "samples", SAMPLES)
        for key, arguments in {
            "many": (source, folder / "out", 0),
            "many_again": (source, folder / "out", 0),
            "samples": (samples, folder / "plain", 0),
            "samples_with_thumbnails": (samples, folder / "drawn", 96),
        }.items():
            results[key], _ = isolated(partial(ran, *arguments))
            click.echo(f"{key}: {results[key]}", err=True)
    write_result(output, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
