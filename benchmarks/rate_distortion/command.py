"""The whole benchmark from one command: measure what is missing, then write what was found."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from benchmarks.assets.source import Source, sources
from benchmarks.codecs import CODECS, EVERY_CORE, OPTIONAL
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target
from benchmarks.rate_distortion.results import write_results
from benchmarks.rate_distortion.runner import Finished, Job, drawings, plan, run
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.textures import TEXTURES

QUICK_ASSETS = 2
NAMES = (*CODECS, TEXTURES)
USUAL = [name for name in NAMES if name not in OPTIONAL]
TARGETS = [Target("delta rate of distance", ("mean_delta_rate", "distance"), -0.45)]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of the means over all assets in a result file."""
    yield from (Asked("mean", target, results["summary"]) for target in TARGETS)


@click.command()
@click.option(
    "--assets",
    type=click.Path(path_type=Path, exists=True),
    default="../shared/assets",
    show_default=True,
    help="A folder of NAME.obj or NAME/NAME.obj.",
)
@click.option("--only", multiple=True, help="An asset by name; may be repeated.")
@click.option("--codec", "codecs", multiple=True, type=click.Choice(NAMES), help="Likewise.")
@click.option("--quick", is_flag=True, help="Two assets, few settings.")
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=os.cpu_count() or 1,
    show_default="one a core",
    help="Points at once, of codecs that use one core.",
)
@click.option("--again", is_flag=True, help="Measure finished points again.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default="build/bench",
    show_default=True,
    help="Folder for the report, and for the points: an interrupted run goes on.",
)
def main(
    assets: Path,
    only: tuple[str, ...],
    codecs: tuple[str, ...],
    quick: bool,
    jobs: int,
    again: bool,
    output: Path,
) -> None:
    """Measure every codec on every asset, then write report.html, results.json and results.csv.

    Times are true only when the machine has nothing else to do. Ours have it to themselves, one by
    one; those of the other codecs are a little longer than with --jobs 1.

    \b
    Example: python -m benchmarks --assets ../shared/assets --quick
    """
    store = Store(output / "points")
    planned: list[Job | Record] = []
    for source in chosen(assets, only, quick):
        click.echo(f"{source.name}: reading", err=True)
        planned += plan(source, codecs or USUAL, quick)
    for each in planned:
        if not isinstance(each, Job):
            store.put(each)
            click.echo(f"{each['asset']} {each['codec']}: {outcome(each)}", err=True)
    points = [each for each in planned if isinstance(each, Job)]
    work([job for job in points if job.codec not in EVERY_CORE], store, jobs, again)
    work([job for job in points if job.codec in EVERY_CORE], store, 1, again)
    work(list(drawings(points, store)), store, jobs, again)
    click.echo(write_results(store, output))


def chosen(assets: Path, only: Sequence[str], quick: bool) -> list[Source]:
    """The assets of a run."""
    found = sources(assets)
    unknown = set(only) - {source.name for source in found}
    if unknown or not found:
        wanted = ", ".join(sorted(unknown)) or "NAME.obj or NAME/NAME.obj"
        raise click.BadParameter(f"{assets}: expected {wanted}, found {len(found)} other assets")
    if only:
        return [source for source in found if source.name in only]
    return found[:QUICK_ASSETS] if quick else found


def work(jobs: Sequence[Job], store: Store, workers: int, again: bool) -> None:
    """Do what is not done yet, telling of each."""
    for finished in run([j for j in jobs if again or not j.done(store)], store, workers):
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
    if "skipped" in record:
        return f"skipped: {record['skipped']}"
    if "failure" in record:
        return f"FAILED: {record['failure']}"
    if "pictures" in record:
        return f"pictures {record['pictures'].get('psnr', float('nan')):.1f} dB"
    if "metrics" not in record:
        return f"{record['bytes']:,} B, {record['psnr']:.1f} dB"
    error = record["metrics"]["geometry"]["larger"]["mean"]
    return f"{record['bytes']:,} B, distance {error:.1e}"
