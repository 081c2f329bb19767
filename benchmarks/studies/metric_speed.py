"""How long the metrics take: 100,000 samples both ways on a mesh against itself, shifted.

python -m benchmarks.studies.metric_speed ../shared/assets/flight_helmet/flight_helmet.obj
"""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import click

from benchmarks.measuring.machine import commit, machine
from benchmarks.measuring.result_file import as_json
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import Reference

SHIFT = 1e-3


@click.command()
@click.argument("asset", type=click.Path(path_type=Path, exists=True))
def main(asset: Path) -> None:
    """Print seconds for the original's points, and for each decode; the target is 5 s together."""
    mesh = load_mesh(asset)
    moved = replace(mesh, positions=mesh.positions + SHIFT)
    marks = [(time.perf_counter(), time.process_time())]
    reference = Reference.of(mesh)
    marks.append((time.perf_counter(), time.process_time()))
    reference.compare(moved)
    marks.append((time.perf_counter(), time.process_time()))
    (start, busy), (middle, _), (end, rest) = marks
    record = {
        "asset": asset.stem,
        "faces": len(mesh.faces),
        "reference_seconds": round(middle - start, 2),
        "compare_seconds": round(end - middle, 2),
        "cpu_seconds": round(rest - busy, 2),
    }
    click.echo(as_json(record | {"commit": commit(), "machine": machine()}))


if __name__ == "__main__":
    main()
