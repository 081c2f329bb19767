"""An old build of `nisp` and the new one by turns: time and memory of an encode, what comes of it.

    python -m benchmarks.headline.encode_time --old ../old --preset balanced --rounds 3

OLD is a git worktree of an older commit, or the interpreter of an environment that has an older
build. Each `nisp encode` is a whole process. Both files are decoded to a GLB by the build that
wrote them, and the meshes judged by the metrics of this tree: one ruler for both. Results are
kept run by run: an interrupted bench goes on where it stopped. The first run of a build may
compile its sources and fill the disk's cache, which a median over three rounds leaves out.
Where others use the machine, times say little, and processor times a little more.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path

import click

from benchmarks.assets.source import Source, sources
from benchmarks.headline.encode_time_table import summary, tables
from benchmarks.headline.encode_time_turn import Turn, attempt, turns
from benchmarks.measuring.build import HERE, Build, build_at
from benchmarks.measuring.machine import machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target

RESULTS = Path("benchmarks/results/encode_time.json")
EIGHT = (
    "boombox", "chess_king", "exploding_barrel", "flight_helmet", "food_apple_01", "gz_polaris",
    "spot", "tea_set_01",
)  # fmt: skip
AT_ONCE = ("spot", "boombox", "chess_king")
"""Where `fast` must show something while one waits."""

TARGETS = [
    Target("time, new / old", ("balanced", "ratios", "seconds", "mean"), 0.25),
    Target("time, the worst asset", ("balanced", "ratios", "seconds", "worst"), 0.4),
    Target("bytes, new / old", ("balanced", "ratios", "bytes", "mean"), 1.0),
    Target("distance, new / old", ("balanced", "ratios", "distance", "mean"), 1.0),
    Target("median UV error", ("balanced", "ratios", "uv_median", "mean"), 1.0),
    Target("peak memory, bytes", ("balanced", "largest_peak_bytes"), 0.5e9),
    *(Target(f"fast: {name}, s", ("fast", "new_seconds", name), 8) for name in AT_ONCE),
]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of the presets that are in a result file."""
    found = summary(results["runs"])
    measured = (target for target in TARGETS if target.place[0] in found)
    yield from (Asked("new build", target, found) for target in measured)


def begun(output: Path, builds: dict[str, Build], again: bool) -> Record:
    """The results to go on with.

    Raises ClickException where they are of other builds or another machine: times that were not
    taken by turns say nothing of each other.
    """
    header = {
        "commit": builds["new"].name,
        "old_commit": builds["old"].name,
        "machine": machine(),
        "versions": versions(),
    }
    found = {} if again else result_so_far(output)
    for name in ("commit", "old_commit", "machine"):
        if found and found[name] != header[name]:
            raise click.ClickException(
                f"{output}: {name}: expected {header[name]}, found {found[name]}; "
                "--again measures everything anew, -o writes elsewhere"
            )
    return {**header, "runs": found.get("runs", [])}


def work(
    plan: Sequence[Turn],
    builds: dict[str, Build],
    found: dict[str, Path],
    output: Path,
    again: bool,
) -> Record:
    """Measure what is missing, keeping each result at once -> all results."""
    results = begun(output, builds, again)
    left = [turn for turn in plan if not turn.done(results["runs"])]
    for done, turn in enumerate(left, start=1):
        record = attempt(turn, builds[turn.build], _source(found[turn.asset]), results["runs"])
        others = [each for each in results["runs"] if not turn.same(each)]
        results["runs"] = [*others, record]
        write_result(output, results)
        click.echo(f"[{done}/{len(left)}] {told(record)}", err=True)
    return results


@lru_cache(maxsize=1)
def _source(path: Path) -> Source:
    """Turns come asset by asset, so one asset at a time is enough."""
    return Source(path)


def told(record: Record) -> str:
    """One run in words."""
    what = "{asset} {preset}, seed {seed}, round {round}, {build}: ".format(**record)
    if "failure" in record:
        return f"{what}FAILED: {record['failure']}"
    distance = record["errors"]["distance"]
    return f"{what}{record['seconds']:.1f} s, {record['bytes']:,} B, distance {distance:.2e}"


def chosen(folder: Path, only: Sequence[str]) -> dict[str, Path]:
    """Asset -> its OBJ: those asked for; else of the eight those that are there, else all.

    Raises BadParameter when one that was asked for is missing, or there is none.
    """
    found = {source.name: source.path for source in sources(folder)}
    names = only or [name for name in EIGHT if name in found] or list(found)
    missing = [name for name in names if name not in found]
    if missing or not names:
        raise click.BadParameter(f"{folder}: expected {', '.join(missing) or 'NAME/NAME.obj'}")
    return {name: found[name] for name in names}


@click.command()
@click.option(
    "--old",
    type=click.Path(path_type=Path, exists=True),
    help="A git worktree of the older build, or an interpreter beside whose nisp it is.",
)
@click.option(
    "--old-python",
    type=click.Path(path_type=Path, exists=True),
    help="What runs the worktree; its .venv unless told, our own where it has none.",
)
@click.option(
    "--new",
    type=click.Path(path_type=Path, exists=True),
    default=HERE,
    help="The same of the newer build; this tree unless told.",
)
@click.option("--new-python", type=click.Path(path_type=Path, exists=True), help="Likewise.")
@click.option(
    "--assets",
    type=click.Path(path_type=Path),
    default="../shared/assets",
    show_default=True,
)
@click.option("--only", multiple=True, help="An asset; may be repeated. The eight unless told.")
@click.option("--preset", "presets", multiple=True, default=["balanced"], show_default=True)
@click.option("--seeds", type=click.IntRange(1), default=1, show_default=True)
@click.option("--rounds", type=click.IntRange(1), default=3, show_default=True)
@click.option("--again", is_flag=True, help="Begin anew.")
@click.option("--table", "only_table", is_flag=True, help="Measure nothing.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(
    old: Path | None,
    old_python: Path | None,
    new: Path,
    new_python: Path | None,
    assets: Path,
    only: tuple[str, ...],
    presets: tuple[str, ...],
    seeds: int,
    rounds: int,
    again: bool,
    only_table: bool,
    output: Path,
) -> None:
    """Measure both builds by turns; print ratios new / old and asked against measured."""
    if only_table:
        results = result_so_far(output)
    elif old is None:
        raise click.UsageError("--old: expected the older build, found none")
    else:
        builds = {"old": build_at(old, old_python), "new": build_at(new, new_python)}
        found = chosen(assets, only)
        plan = list(turns(list(found), presets, seeds, rounds))
        results = work(plan, builds, found, output, again)
    click.echo(tables(results.get("runs", [])))
    for each in asked({"runs": results.get("runs", [])}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
