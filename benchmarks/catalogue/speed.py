"""`nisp batch` against a shell loop of `nisp encode`, and a Ray cluster against processes.

    python -m benchmarks.catalogue.speed [--count 64] [--preset fast] [--ray PYTHON] [-o OUT.json]

Half of the loop, the batch, the other half, the batch on Ray: by turns, as others may use the
machine. The loop encodes one asset after the other on all cores. PYTHON is an interpreter that has
nispcodec and Ray, whose cluster of two workers is begun on this machine. All outputs are compared
byte by byte.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import click

from benchmarks.catalogue.samples import write_samples
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target
from nispcodec.catalogue.find import output_of
from nispcodec.io.load import READERS

RESULTS = Path("benchmarks/results/batch.json")
TARGETS = (
    Target("batch / loop", ("batch_to_loop",), 0.6),
    Target("outputs that differ", ("different",), 0),
    Target("Ray / processes", ("ray_to_batch",), 1.15),
    Target("Ray: outputs that differ", ("ray_different",), 0),
)


def asked(results: Record) -> Iterator[Asked]:
    """The targets of a result file."""
    return (Asked("catalogue", target, results) for target in TARGETS)


def looped(paths: Iterable[Path], source: Path, output: Path, preset: str, scratch: Path) -> Record:
    """A shell loop: wall and processor seconds."""
    words = []
    for path in paths:
        place = output / output_of(path.relative_to(source).as_posix())
        place.parent.mkdir(parents=True, exist_ok=True)
        nisp = f"'{sys.executable}' -m nispcodec encode"
        words.append(f"{nisp} '{path}' -o '{place}' --preset {preset} --quiet > /dev/null")
    return _took(["sh", "-c", "\n".join(["set -e", *words])], scratch)


def batched(
    python: Path, source: Path, output: Path, preset: str, scratch: Path, more: tuple[str, ...] = ()
) -> Record:
    """One batch: wall and processor seconds, and what its encodes took of them."""
    words = [str(python), "-m", "nispcodec", "batch", str(source), "-o", str(output)]
    found = _took([*words, "--preset", preset, "--quiet", *more], scratch)
    lines = (output / "catalogue.jsonl").read_text(encoding="utf-8").splitlines()
    records = [json.loads(line)["seconds"] for line in lines]
    for name in ("encode", "all"):
        found[f"{name}_seconds"] = round(sum(each[name] for each in records), 1)
    return found


def _took(command: list[str], scratch: Path) -> Record:
    load = os.getloadavg()[0]
    done = run(command, scratch)
    return {"seconds": done.seconds, "processor_seconds": done.cpu_seconds, "load": load}


def different(first: Path, second: Path) -> int:
    """How many outputs of the first folder the second has not, or otherwise."""
    paths = [path.relative_to(first) for path in first.rglob("*.nisp")]
    return sum(
        not (second / path).exists() or (first / path).read_bytes() != (second / path).read_bytes()
        for path in paths
    )


def measured(count: int, preset: str, ray: Path | None, folder: Path) -> Record:
    """All of it, in a folder."""
    source = write_samples(folder / "in", count)
    paths = sorted(path for path in source.rglob("*") if path.suffix in READERS)
    loop, batch, far = folder / "loop", folder / "batch", folder / "ray"
    halves = [looped(paths[::2], source, loop, preset, folder)]
    found: Record = {"count": len(paths), "preset": preset}
    found["batch"] = batched(Path(sys.executable), source, batch, preset, folder)
    click.echo(f"batch: {found['batch']}", err=True)
    halves.append(looped(paths[1::2], source, loop, preset, folder))
    found["loop"] = {name: round(sum(each[name] for each in halves), 2) for name in halves[0]}
    found["loop"]["load"] /= len(halves)
    click.echo(f"loop: {found['loop']}", err=True)
    found["batch_to_loop"] = found["batch"]["seconds"] / found["loop"]["seconds"]
    found["different"] = different(loop, batch)
    if ray is not None:
        options = ("--engine", "ray", "--jobs", "2")
        found["ray"] = batched(ray, source, far, preset, folder, options)
        click.echo(f"ray: {found['ray']}", err=True)
        found["ray_to_batch"] = found["ray"]["seconds"] / found["batch"]["seconds"]
        found["ray_different"] = different(batch, far)
    return found


@click.command()
@click.option("--count", default=64, show_default=True)
@click.option("--preset", default="fast", show_default=True)
@click.option("--ray", type=click.Path(path_type=Path, exists=True), metavar="PYTHON")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(count: int, preset: str, ray: Path | None, output: Path) -> None:
    """Measure; print asked against measured."""
    results: Record = {"commit": commit(), "machine": machine(), "versions": versions()}
    with tempfile.TemporaryDirectory() as folder:
        results |= measured(count, preset, ray and ray.absolute(), Path(folder))
    write_result(output, results)
    for each in asked(results):
        click.echo(each.line())


if __name__ == "__main__":
    main()
