"""What an encode does before it trains: how long it takes, and its labels by another build.

python -m benchmarks.studies.preparation_time OLD --labels ../shared/assets/spot/spot.obj ...

OLD is another checkout of this project. Each asset is prepared by it and by this one in turns, each
time in a process of its own; a table shows seconds (of the quickest turn), the seconds of each
processor together, and the highest memory. With `--labels` OLD labels the points of this build too.
With `--write benchmarks/results/preparation_time.json` all of it is kept. Ratios are of the seconds
of processors: others on the machine make the wall time longer, and these hardly.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from pathlib import Path
from typing import Any

import click
import numpy as np

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each

HERE = Path(__file__).resolve()
Seconds = dict[str, list[float]]
SETS = ("near_surface", "cube", "asymmetric", "thin_walls", "closing_surface", "surface")
RATIO = Target("seconds of processors, new / old", ("ratio",), 0.3)
AGAIN = ("undersampled_charts", "by_texture_gradient", "by_chart_error")


@click.command()
@click.argument("old", type=click.Path(path_type=Path, exists=True, file_okay=False))
@click.argument("assets", type=click.Path(path_type=Path, exists=True), nargs=-1, required=True)
@click.option("--turns", default=2, show_default=True)
@click.option("--labels", is_flag=True, help="Compare labels of the same points.")
@click.option("--write", type=click.Path(path_type=Path), help="The result file.")
def main(old: Path, assets: tuple[Path, ...], turns: int, labels: bool, write: Path | None) -> None:
    """Print a table of seconds for each asset, and the shares of labels that differ."""
    new, found = HERE.parents[2], {}
    for asset in assets:
        found[asset.stem] = record = _by_turns(old, new, asset, turns)
        click.echo("\n".join(_table(asset.stem, record)))
        if labels:
            record["labels_that_differ"] = _labels_that_differ(old, new, asset)
            click.echo(f"  labels that differ: {record['labels_that_differ']}")
    ratios = [record["ratio"] for record in found.values()]
    click.echo(f"mean ratio {np.mean(ratios):.3f}, worst {max(ratios):.3f}")
    if write:
        where = {"commit": commit(), "old": commit(old), "machine": machine()}
        write_result(write, where | {"versions": versions(), "assets": found})


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda asset: [RATIO])


def _by_turns(old: Path, new: Path, asset: Path, turns: int) -> Record:
    """By build and part [wall, processor seconds] of the turn with the fewest of processors."""
    runs: dict[str, list[Any]] = {"old": [], "new": []}
    for _ in range(turns):
        for name, place in (("old", old), ("new", new)):
            runs[name].append(_run(place, "time", asset))
    best: Record = {name: min(each, key=lambda r: r["total"][1]) for name, each in runs.items()}
    return best | {"ratio": best["new"]["total"][1] / best["old"]["total"][1]}


def _table(asset: str, record: Record) -> Iterator[str]:
    yield f"{asset}: {record['ratio']:.2f}  (wall, processor seconds)"
    for part in record["old"] | record["new"]:
        shown = (record[name].get(part, [0.0, 0.0]) for name in ("old", "new"))
        yield f"  {part:24}" + " -> ".join(f"{w:8.2f} {c:8.2f}" for w, c in shown)


def _labels_that_differ(old: Path, new: Path, asset: Path) -> Record:
    with tempfile.TemporaryDirectory() as folder:
        points = Path(folder) / "sets.npz"
        _run(new, "write", asset, points)
        found: Record = _run(old, "compare", asset, points)
    return found


def _run(place: Path, *what: object) -> Any:
    environment = os.environ | {"PYTHONPATH": str(place)}
    command = [sys.executable, str(HERE), *map(str, what)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=place)
    if done.returncode:
        raise click.ClickException(done.stderr)
    return json.loads(done.stdout)


def _one(what: str, asset: Path, points: Path | None = None) -> object:
    """In a process of its own: what one build does."""
    from nispcodec.dataset.recipes import training_sets
    from nispcodec.dataset.sampler import Sampler
    from nispcodec.geometry import analysis
    from nispcodec.io.load import load_mesh

    mesh = load_mesh(asset)
    if what == "compare" and points is not None:
        return _differing(analysis.analyze(mesh).label, points)
    times: Seconds = {}
    _timed(times, analysis, "build_solid")
    for name in SETS + AGAIN:
        _timed(times, Sampler, name)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    found = _watched(times, "total", lambda: _prepared(times, analysis, mesh))
    sets = _watched(times, "training_sets", lambda: training_sets(Sampler(found)))
    times["total"] = [a + b for a, b in zip(times["total"], times["training_sets"], strict=True)]
    if what == "write" and points is not None:
        flat = {
            f"{each.name}.{part.name}": getattr(getattr(sets, each.name), part.name)
            for each in fields(sets)
            for part in fields(getattr(sets, each.name))
        }
        np.savez(points, **flat)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return times | {"MB before, at most": [before, peak]}


def _prepared(times: Seconds, analysis: Any, mesh: object) -> Any:
    return _watched(times, "analyze", lambda: analysis.analyze(mesh))


def _differing(label: Any, points: Path) -> dict[str, dict[str, float]]:
    """By set the shares of labels that differ; charts and UVs are learned without signs."""
    stored, found = np.load(points), {}
    for name in ("distance", "charts", "uvs", "held_out_distance", "held_out_surface"):
        here = {part: stored[f"{name}.{part}"] for part in ("points", "sdf", "chart", "uv")}
        there = label(here["points"].astype(np.float64), "distance" in name)
        ours = here["chart"] < len(label.charts)  # not on openings
        found[name] = {
            "sign": float(
                ((here["sdf"] < -1e-6) & (there.sdf > 1e-6)).mean()
                + ((here["sdf"] > 1e-6) & (there.sdf < -1e-6)).mean()
            ),
            "distance": float((np.abs(np.abs(here["sdf"]) - np.abs(there.sdf)) > 1e-5).mean()),
            "chart": float((here["chart"] != there.chart)[ours].mean()),
            "uv": float((np.abs(here["uv"] - there.uv).max(axis=1) > 1e-3)[ours].mean()),
        }
    return found


def _timed(times: Seconds, owner: Any, name: str) -> None:
    """Adds up the time of every call of a function, wherever it is in threads or not."""
    plain = getattr(owner, name, None)
    if plain is None:
        return

    def timed(*given: Any, **named: Any) -> Any:
        return _watched(times, name, lambda: plain(*given, **named))

    setattr(owner, name, timed)


def _watched(times: Seconds, name: str, call: Callable[[], Any]) -> Any:
    wall, busy = time.perf_counter(), time.process_time()
    result = call()
    sums = times.setdefault(name, [0.0, 0.0])
    sums[0] += time.perf_counter() - wall
    sums[1] += time.process_time() - busy
    return result


if __name__ == "__main__":
    if len(sys.argv) > 1 and sys.argv[1] in ("time", "write", "compare"):
        json.dump(_one(sys.argv[1], *map(Path, sys.argv[2:])), sys.stdout)
    else:
        main()
