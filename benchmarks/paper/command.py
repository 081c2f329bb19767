"""Measure what is cheap, take the rest from committed results, write table and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from itertools import groupby
from pathlib import Path

import click

from benchmarks.headline.main_job import RESULTS as MAIN_JOB
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, read_result, write_result
from benchmarks.paper.quality import quality
from benchmarks.paper.queries import queries
from benchmarks.paper.row import Comparison
from benchmarks.paper.sizes import sizes
from benchmarks.paper.views import views
from nispcodec.core.atomic_write import write_atomic

HEAD = "# The paper's numbers beside ours\n\nWritten by `python -m benchmarks.paper`.\n"


def markdown(rows: Sequence[Comparison]) -> str:
    """A table for each of the paper's, and below it what differs."""
    parts = [HEAD]
    for title, group in groupby(rows, key=lambda row: row.table):
        alike = list(group)
        parts.append(f"\n## {title}\n\n| | published | ours |\n|---|---|---|\n")
        parts += [
            f"| {row.quantity} | {row.published:.4g} {row.unit} | {row.ours:.4g} {row.unit} |\n"
            for row in alike
        ]
        notes = dict.fromkeys(row.differs for row in alike)
        parts.append("\n" + "".join(f"What differs: {note}.\n" for note in notes))
    return "".join(parts)


@click.command()
@click.option("-o", "--output", type=click.Path(path_type=Path), default="benchmarks/results")
def main(output: Path) -> None:
    """Write paper.json and paper.md into a folder."""
    rows = [*sizes(), *queries(), *quality(read_result(MAIN_JOB)), *views()]
    record: Record = {"commit": commit(), "machine": machine(), "versions": versions()}
    write_result(output / "paper.json", record | {"rows": [asdict(row) for row in rows]})
    write_atomic(output / "paper.md", markdown(rows).encode())
    click.echo(markdown(rows))
