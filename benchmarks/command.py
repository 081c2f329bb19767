"""The whole benchmark from one command: measure what is missing, then write what was found."""

from __future__ import annotations

from pathlib import Path

import click

from benchmarks.codecs import CODECS
from benchmarks.runner import Finished, Job, plan, run
from benchmarks.source import sources
from benchmarks.store import Record, Store

QUICK_ASSETS = 2


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), default="../shared/assets")
@click.option("--only", multiple=True, help="An asset by name; may be repeated.")
@click.option("--codec", "codecs", multiple=True, type=click.Choice(list(CODECS)))
@click.option("--quick", is_flag=True, help="Two assets, few settings.")
@click.option("--jobs", type=click.IntRange(1), default=1, show_default=True)
@click.option("--again", is_flag=True, help="Measure finished points again.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default="build/bench")
def main(
    assets: Path,
    only: tuple[str, ...],
    codecs: tuple[str, ...],
    quick: bool,
    jobs: int,
    again: bool,
    output: Path,
) -> None:
    """Measure every codec on every asset.

    \b
    Example: python -m benchmarks --assets ../shared/assets --quick
    """
    chosen = [source for source in sources(assets) if not only or source.name in only]
    chosen = chosen[:QUICK_ASSETS] if quick and not only else chosen
    store = Store(output / "points")
    planned = list(plan(chosen, codecs or CODECS, quick))
    for each in planned:
        if not isinstance(each, Job):
            store.put(each, b"")
    todo = [each for each in planned if isinstance(each, Job)]
    todo = [j for j in todo if again or not store.holds(j.path.stem, j.codec, j.setting)]
    for finished in run(todo, store, jobs):
        click.echo(told(finished), err=True)


def told(finished: Finished) -> str:
    """One line about a point that ended."""
    record, minutes = finished.record, finished.seconds_left / 60
    setting = " ".join(f"{name}={value}" for name, value in record["setting"].items())
    return (
        f"[{finished.done}/{finished.total}, {minutes:.0f} min left] "
        f"{record['asset']} {record['codec']} {setting}: {outcome(record)}"
    )


def outcome(record: Record) -> str:
    """What came of a point, in a few words."""
    if "failure" in record:
        return f"FAILED: {record['failure']}"
    error = record["metrics"]["geometry"]["larger"]["mean"]
    return f"{record['bytes']:,} B, distance {error:.1e}"
