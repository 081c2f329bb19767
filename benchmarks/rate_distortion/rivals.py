"""The line to beat: what the strongest mesh codecs reach on each asset, at every size.

    npm install --no-save meshoptimizer@1.3.0 gltfpack@1.3.0
    python -m benchmarks.rate_distortion.rivals --assets ../shared/assets

Every codec in RIVALS is tried over a grid, and its decodes measured roughly, by ROUGH points each
way. Near the distance of our file, which `main_job.json` has, more shares of faces are tried; and
the settings that decide the duel are measured as everything else is, by color too. Where faces are
hidden in other bodies, all settings leave them out. What was tried or measured before is kept.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from pathlib import Path

import click

from benchmarks.assets import simplify_update
from benchmarks.assets.source import SAMPLES, SEED, Source, sources
from benchmarks.codecs import Setting, codec, draco, gltfpack, simplified_gltfpack
from benchmarks.codecs.simplified_draco import NOTABLE
from benchmarks.codecs.simplified_update_draco import UV_WEIGHTS, moving
from benchmarks.headline.duel import our_rows
from benchmarks.headline.main_job import RESULTS as MAIN_JOB
from benchmarks.measuring.machine import commit, versions
from benchmarks.measuring.result_file import read_result, write_result
from benchmarks.rate_distortion.point import measured
from benchmarks.rate_distortion.rows import NAMES, Row, as_csv, row
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.summary import RIVALS
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.atomic_write import write_atomic
from nispcodec.geometry.analysis import normalizing_frame
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.errors import Counted, Errors, Original
from nispcodec.simplify.triangles import Triangles, distinct_corners

FOLDER = Path("benchmarks/results")
POINTS = "rivals.csv"
NPM = {"meshoptimizer": simplify_update.VERSION, "gltfpack": gltfpack.VERSION}
KEPT = (1.0, 0.84, 0.59, 0.42, 0.25, 0.125, 0.0625)
BITS = ((9, 9), (10, 10), (11, 10), (12, 11))
FINE, FINE_BITS = 0.84, ((13, 12),)
"""Rounding counts where most of the faces are kept."""
FEWEST = 150
LARGE, LARGE_KEPT = 50_000, 0.25
"""Of so many faces, larger shares take more bytes than any file of ours, and each takes seconds."""
# Whose bytes are 1.2 to 3 times Draco's for the same errors: enough settings to say so.
FEW_KEPT, FEW_BITS = (0.84, 0.42, 0.125), ((10, 10), (12, 11))
ROUGH = 20_000
FARTHEST = 3e-3
"""Settings that are further off, in mean distance, are compared with nothing of ours."""
NEAR, BETWEEN = 1.6, (0.84, 1.19)
"""Settings whose distance is ours within a factor, and what shares of their faces are tried too."""
DECIDING = 3
"""So many settings are measured in full: the smallest as near as ours, the nearest as small."""
SLACK = 1.1
"""What rough errors may be off by."""


Choice = tuple[str, Setting]
"""A codec and one of its settings."""


@dataclass(frozen=True)
class Trial:
    """A setting with its bytes and rough mean errors."""

    codec: str
    setting: Setting
    bytes: int
    distance: float
    uv: float


def grid(source: Source) -> Iterator[Choice]:
    """Every setting that is tried; those that differ in bits alone come one after the other."""
    surface = "outer" if source.hidden_share > NOTABLE else "all"
    total = len(source.mesh.faces)
    most = 1.0 if total < LARGE else LARGE_KEPT
    shares = [kept for kept in KEPT if kept <= most and kept * total > FEWEST]
    settings: list[Setting] = [
        {"surface": surface, "kept": kept, "qp": qp, "qt": qt}
        for kept in shares
        for qp, qt in (*BITS, *(FINE_BITS if kept >= FINE else ()))
    ]
    few = [each for each in settings if each["kept"] in FEW_KEPT]
    few = [each for each in few if (each["qp"], each["qt"]) in FEW_BITS]
    by_codec = {
        "draco": draco.settings(source, quick=False)[-1:],
        "simplified_draco": settings,
        "simplified_update_draco": moving(settings),
        "simplified_update_meshopt": [e for e in moving(few) if e["uv_weight"] == UV_WEIGHTS[1]],
        "simplified_gltfpack": simplified_gltfpack.settings(source, quick=True),
    }
    yield from ((name, setting) for name in RIVALS for setting in by_codec[name])


def ruler(source: Source) -> Callable[[TexturedMesh], Errors]:
    """Measures decoded meshes roughly."""
    frame = normalizing_frame(source.mesh)
    triangles = Triangles.of(source.mesh, frame)
    hidden = source.hidden_share > NOTABLE
    outer = source.outer_faces[distinct_corners(source.mesh)]
    counted = Counted.of(outer) if hidden else None
    original = Original.of(triangles, Tree(triangles.corners), ROUGH, SEED, counted)

    def errors(decoded: TexturedMesh) -> Errors:
        return original.errors(replace(decoded, positions=frame.to_normalized(decoded.positions)))

    return errors


def tried(source: Source, settings: Iterable[Choice]) -> Iterator[Trial]:
    """Every setting but those that leave nothing."""
    errors = ruler(source)
    for name, setting in settings:
        try:
            data = codec(name).encode(source, setting)
        except ValueError as why:
            click.echo(f"{source.name} {name} {setting}: {why}", err=True)
            continue
        found = errors(codec(name).decode(data, source))
        yield Trial(name, setting, len(data), found.distance, found.uv)


def between(every: Sequence[Trial], ours: Row) -> Iterator[Choice]:
    """For the best settings of the grid about as near as ours: somewhat more and fewer faces."""
    low, high = ours["distance"] / NEAR, ours["distance"] * NEAR
    near = [each for each in every if low <= each.distance <= high]
    both = best(near), best([each for each in near if each.uv <= SLACK * ours["uv"]])
    chosen = {id(each): each for some in both for each in some if "surface" in each.setting}
    for each, factor in product(chosen.values(), BETWEEN):
        kept = round(factor * float(each.setting["kept"]), 3)
        if kept < 1:
            yield each.codec, {**each.setting, "kept": kept}
    if not any(each.bytes <= ours["bytes"] for each in every):
        yield from smaller(every)


def smaller(every: Sequence[Trial]) -> Iterator[Choice]:
    """Every way to simplify with half of the fewest faces, coarsely rounded."""
    shared = [each for each in every if "surface" in each.setting]
    least = min(float(each.setting["kept"]) for each in shared)
    for each in shared:
        if each.setting["kept"] == least and each.setting["qp"] == BITS[0][0]:
            yield each.codec, {**each.setting, "kept": least / 2}


def best(every: Sequence[Trial]) -> list[Trial]:
    """Those of which no other has fewer bytes and a smaller distance."""
    steps: list[Trial] = []
    for each in sorted(every, key=lambda each: (each.bytes, each.distance)):
        if not steps or each.distance < steps[-1].distance:
            steps.append(each)
    return steps


def trials(source: Source, folder: Path, ours: Row | None) -> list[Trial]:
    """The trials of an asset, from the folder or made and kept there."""
    found = stored(folder / f"{source.name}.json", lambda: tried(source, grid(source)))
    if ours is None:
        return found
    path = folder / f"{source.name} near {ours['distance']:.2e}.json"
    return found + stored(path, lambda: tried(source, between(found, ours)))


def stored(path: Path, make: Callable[[], Iterable[Trial]]) -> list[Trial]:
    """What the file has, or what is made and written to it."""
    if not path.exists():
        made = json.dumps([asdict(each) for each in make()])
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, made.encode())
    return [Trial(**each) for each in json.loads(path.read_text(encoding="utf-8"))]


def deciding(every: Sequence[Trial], ours: Row) -> list[Trial]:
    """The smallest that may be as near as ours, with UVs and without, and the best as small."""
    near = [each for each in every if each.distance <= SLACK * ours["distance"]]
    textured = [each for each in near if each.uv <= SLACK * ours["uv"]]
    small = [each for each in every if each.bytes <= ours["bytes"]]
    ranked = [sorted(some, key=lambda each: each.bytes) for some in (near, textured)]
    ranked += [sorted(small, key=lambda each: each.distance)]
    ranked += [sorted(small, key=lambda each: each.uv)]
    return [each for some in ranked for each in some[:DECIDING]]


def points(
    source: Source, every: Sequence[Trial], chosen: Sequence[Trial], store: Store
) -> list[Row]:
    """Every trial as a point; the chosen ones measured in full, from the store or anew."""
    full = {id(each) for each in chosen}
    return [
        _measured(source, each, store) if id(each) in full else rough(source, each)
        for each in every
    ]


def rough(source: Source, trial: Trial) -> Row:
    """A trial as a point, without what was not measured."""
    label = " ".join(str(value) for value in trial.setting.values())
    known = asdict(trial) | {"asset": source.name, "setting": label}
    return {name: known.get(name) for name in NAMES}


def _measured(source: Source, trial: Trial, store: Store) -> Row:
    record = store.find(source.name, trial.codec, trial.setting)
    if record is None or "failure" in record:
        record, data = measured(source, trial.codec, trial.setting)
        store.put(record, data)
    found = row(record)
    click.echo(f"  {trial.codec} {found['setting']}: {found['bytes']} B, {found['distance']:.2e}")
    return found


def write(table: dict[str, list[Row]], folder: Path) -> None:
    """Every point as rivals.csv, and beside it with what they were measured."""
    write_atomic(folder / POINTS, as_csv([row for rows in table.values() for row in rows]).encode())
    kept = {name: len(rows) for name, rows in table.items()}
    header = {"commit": commit(), "versions": versions(), "npm": NPM}
    samples = {"rough": ROUGH, "with a color": SAMPLES}
    write_result(folder / "rivals.json", {**header, "samples": samples, "points": kept})


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset by name; may be repeated.")
@click.option("--work", type=click.Path(path_type=Path), default="build/rivals", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=FOLDER, show_default=True)
def main(assets: Path, only: tuple[str, ...], work: Path, output: Path) -> None:
    """Try and measure what is not done yet; write every point as OUTPUT/rivals.csv."""
    table: dict[str, list[Row]] = {}
    files = {each["asset"]: each for each in our_rows(read_result(MAIN_JOB)["assets"])}
    for source in sources(assets):
        if only and source.name not in only:
            continue
        ours = files.get(source.name)
        every = trials(source, work / "trials", ours)
        click.echo(f"{source.name}: {len(every)} settings tried")
        near = [each for each in every if each.distance <= FARTHEST]
        chosen = [] if ours is None else deciding(near, ours)
        table[source.name] = points(source, near, chosen, Store(work / "points"))
        write(table, output)


if __name__ == "__main__":
    main()
