"""The line to beat: what the strongest mesh codecs reach on each asset, at every size.

    npm install --no-save meshoptimizer@1.3.0 gltfpack@1.3.0
    python -m benchmarks.rate_distortion.rivals --assets ../shared/assets

Every codec in RIVALS is tried over a grid, and its decodes measured roughly, by ROUGH points each
way. The settings on the lower hulls are measured as everything else is, and their colors too. Where
faces are hidden in other bodies, all settings leave them out. Finished assets are not tried again,
nor finished points measured again.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path

import click

from benchmarks.assets.source import SAMPLES, SEED, Source, sources
from benchmarks.codecs import Setting, codec, draco, simplified_gltfpack
from benchmarks.codecs.simplified_draco import NOTABLE
from benchmarks.codecs.simplified_update_draco import UV_WEIGHTS, moving
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from benchmarks.rate_distortion.hull import lower_hull
from benchmarks.rate_distortion.point import measured
from benchmarks.rate_distortion.rows import Row, row
from benchmarks.rate_distortion.store import Store
from benchmarks.rate_distortion.summary import RIVALS
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.atomic_write import write_atomic
from nispcodec.geometry.analysis import normalizing_frame
from nispcodec.simplify.closest import Tree
from nispcodec.simplify.errors import Errors, Original
from nispcodec.simplify.triangles import Triangles, distinct_corners

RESULTS = Path("benchmarks/results/rivals.json")
KEPT = (1.0, 0.84, 0.59, 0.42, 0.25, 0.125, 0.0625)
BITS = ((9, 9), (10, 10), (11, 10), (12, 11))
FINE, FINE_BITS = 0.84, ((13, 12),)
"""Rounding counts where most of the faces are kept."""
FEWEST = 150
# Whose bytes are about twice Draco's for the same mesh: enough settings to say so.
FEW_KEPT, FEW_BITS = (0.84, 0.42, 0.125), ((10, 10), (12, 11))
ROUGH = 20_000
FARTHEST = 3e-3
"""Settings that are further off, in mean distance, are compared with nothing of ours."""
UV_SHARES = (4.0, 16.0)
"""Mean UV errors in units of the mean distance: what `.nisp` files have is between the two."""
SHOWN = (
    "asset", "codec", "setting", "bytes", "faces", "distance", "uv", "uv_median", "color_psnr",
    "samples", "problem", "commit",
)  # fmt: skip


@dataclass(frozen=True)
class Trial:
    """A setting with its bytes and rough mean errors."""

    codec: str
    setting: Setting
    bytes: int
    distance: float
    uv: float


def grid(source: Source) -> Iterator[tuple[str, Setting]]:
    """Every setting that is tried; those that differ in bits alone come one after the other."""
    surface = "outer" if source.hidden_share > NOTABLE else "all"
    shares = [kept for kept in KEPT if kept * len(source.mesh.faces) > FEWEST]
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
    counted = source.outer_faces[distinct_corners(source.mesh)] if hidden else None
    original = Original.of(triangles, Tree(triangles.corners), ROUGH, SEED, counted)

    def errors(decoded: TexturedMesh) -> Errors:
        return original.errors(replace(decoded, positions=frame.to_normalized(decoded.positions)))

    return errors


def tried(source: Source) -> Iterator[Trial]:
    """Every setting of the grid but those that leave nothing."""
    errors = ruler(source)
    for name, setting in grid(source):
        try:
            data = codec(name).encode(source, setting)
        except ValueError as why:
            click.echo(f"{source.name} {name} {setting}: {why}", err=True)
            continue
        found = errors(codec(name).decode(data, source))
        yield Trial(name, setting, len(data), found.distance, found.uv)


def trials(source: Source, folder: Path) -> list[Trial]:
    """The trials of an asset, from the folder or made and kept there."""
    path = folder / f"{source.name}.json"
    if not path.exists():
        found = json.dumps([asdict(each) for each in tried(source)])
        folder.mkdir(parents=True, exist_ok=True)
        write_atomic(path, found.encode())
    return [Trial(**each) for each in json.loads(path.read_text(encoding="utf-8"))]


def worth(every: Sequence[Trial]) -> list[Trial]:
    """Those on the lower hull of distances, or of distances and UV errors mixed."""
    errors: list[Callable[[Trial], float]] = [lambda each: each.distance]
    errors += [partial(_mixed, share) for share in UV_SHARES]
    clouds = [[(each.bytes, max(error(each), 1e-12)) for each in every] for error in errors]
    chosen = sorted({index for cloud in clouds for index in lower_hull(cloud)})
    return [every[index] for index in chosen]


def _mixed(share: float, trial: Trial) -> float:
    return max(trial.distance, trial.uv / share)


def points(source: Source, every: Sequence[Trial], store: Store) -> list[Row]:
    """Every trial as a point; those on a hull measured in full, from the store or anew."""
    chosen = {id(each) for each in worth(every)}
    return [
        _measured(source, each, store) if id(each) in chosen else rough(source, each)
        for each in every
    ]


def rough(source: Source, trial: Trial) -> Row:
    """A trial as a point, with what it has not as None."""
    label = " ".join(str(value) for value in trial.setting.values())
    known = asdict(trial) | {"asset": source.name, "setting": label, "samples": ROUGH}
    return {name: known.get(name) for name in SHOWN}


def _measured(source: Source, trial: Trial, store: Store) -> Row:
    record = store.find(source.name, trial.codec, trial.setting)
    if record is None or "failure" in record:
        record, data = measured(source, trial.codec, trial.setting)
        store.put(record, data)
    known = row(record) | {"samples": SAMPLES}
    click.echo(f"  {trial.codec} {known['setting']}: {known['bytes']} B, {known['distance']:.2e}")
    return {name: known[name] for name in SHOWN}


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset by name; may be repeated.")
@click.option("--work", type=click.Path(path_type=Path), default="build/rivals", show_default=True)
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(assets: Path, only: tuple[str, ...], work: Path, output: Path) -> None:
    """Try and measure what is not done yet; write every point as JSON."""
    table: dict[str, list[Row]] = {}
    for source in sources(assets):
        if only and source.name not in only:
            continue
        every = [e for e in trials(source, work / "trials") if e.distance <= FARTHEST]
        click.echo(f"{source.name}: {len(every)} settings tried")
        table[source.name] = points(source, every, Store(work / "points"))
        write_result(output, {"commit": commit(), "assets": table})


if __name__ == "__main__":
    main()
