"""What a run leaves: results.json, results.csv, plots and one report to open in a browser."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchmarks.assets.source import SAMPLES, SEED
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.rate_distortion.rows import ERRORS, as_csv, row
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.summary import summarized
from benchmarks.rate_distortion.textures import TEXTURES
from benchmarks.report.page import page
from benchmarks.report.plots import draw
from nispcodec.core.atomic_write import write_atomic

SCHEMA = 1


def write_results(store: Store, folder: Path) -> Path:
    """Write everything into a folder -> the path of the report."""
    results = gathered(store)
    write_result(folder / "results.json", results)
    rows = [row(record) for record in results["points"]]
    write_atomic(folder / "results.csv", as_csv(rows).encode())
    for error in ERRORS:
        draw(rows, folder / f"{error}.png", error)
    write_atomic(folder / "report.html", page(results, store).encode())
    return folder / "report.html"


def gathered(store: Store) -> Record:
    """All points with where, when and with what they were measured, and the summary."""
    records = store.records()
    points = current([record for record in records if record["codec"] != TEXTURES])
    return {
        "schema": SCHEMA,
        "commit": commit(),
        "machine": machine(),
        "versions": versions(),
        "seeds": {"samples": SEED, "encoder": SEED},
        "samples": SAMPLES,
        "points": points,
        "textures": [record for record in records if record["codec"] == TEXTURES],
        "summary": summarized([row(record) for record in points]),
    }


def current(points: Sequence[Record]) -> list[Record]:
    """Without what an earlier run could not do with a codec, where a later one could."""
    ran = {(each["asset"], each["codec"]) for each in points if "bytes" in each}
    return [
        each
        for each in points
        if "skipped" not in each or (each["asset"], each["codec"]) not in ran
    ]
