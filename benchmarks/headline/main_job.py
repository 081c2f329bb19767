"""The main job on real assets, through the real command line: asked against measured.

    python -m benchmarks.headline.main_job --assets ../shared/assets [--only spot] [--seed 1]

Results are kept asset by asset: an interrupted run goes on where it stopped. Those of other seeds
than 0 are kept beside, under `seeds`.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.process import Run, run
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.asset import TexturedMesh
from nispcodec.format import unpack
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import compare
from nispcodec.metrics.pictures import compare_pictures
from nispcodec.metrics.surface import frame_of
from nispcodec.model import NispModel
from nispcodec.render.camera import turntable
from nispcodec.render.views import on_white, render_views

RESULTS = Path("benchmarks/results/main_job.json")
NISP = Path(sys.executable).with_name("nisp")
PRECISE = {"spot", "food_apple_01", "chess_king", "tea_set_01"}
LARGE = {"flight_helmet", "gz_polaris"}
LOW_POLY = {"gz_fire_truck", "gz_polaris", "kaykit_knight", "painted_wooden_cabinet"}
VIEWS = 4


def targets(asset: str) -> list[Target]:
    """What is asked of an asset."""
    precise, large = asset in PRECISE, asset in LARGE
    distance, uv = ("metrics", "geometry", "larger", "mean"), ("metrics", "uv", "larger", "median")
    each = [
        Target("encode, s", ("encode", "seconds"), 120),
        Target("peak memory, bytes", ("encode", "peak_bytes"), 2e9),
        Target("mean distance", distance, 5e-4 if precise else 1.5e-3),
        Target("median UV error", uv, 5e-4 if precise else 1e-3),
        Target("geometry+UV, bytes", ("bytes", "geometry_uv"), 90e3 if large else 45e3),
        Target("spurious components", ("metrics", "spurious", "count"), 0),
        Target("made-up surface, share", ("made_up_share",), 5e-4),
    ]
    if asset in LOW_POLY:
        each.append(Target("decoded faces / original's", ("decoded_share",), 2))
    accuracy = Target("chart accuracy", ("metrics", "charts", "accuracy"), 0.99, at_least=True)
    return [*each, accuracy] if precise else each


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], targets)


def measure(source: Path, folder: Path, preset: str, seed: int) -> Record:
    """Encode, decode, read the decode back and compare: everything about one asset."""
    model, decoded = folder / f"{source.stem}.nisp", folder / f"{source.stem}.glb"
    settings = ["--preset", preset, "--seed", str(seed)]
    encoding = run([NISP, "encode", source, "-o", model, *settings, "--json"], folder)
    decoding = run([NISP, "decode", model, "--mesh", "-o", decoded], folder)
    info = json.loads(run([NISP, "info", model, "--json"], folder).stdout)
    original, back = load_mesh(source), load_mesh(decoded)
    return {
        "commit": commit(),
        "preset": preset,
        "seed": seed,
        "faces": len(original.faces),
        "decoded_faces": len(back.faces),
        "decoded_share": len(back.faces) / len(original.faces),
        "encode": cost(encoding),
        "decode": cost(decoding),
        "report": json.loads(encoding.stdout),
        "bytes": info["bytes"],
        "networks": info["networks"],
        "made_up_share": info["measured"].get("made_up_share"),
        "metrics": distortion(original, back, model),
    }


def cost(finished: Run) -> Record:
    """Time and memory of a command, without what it printed."""
    return {name: value for name, value in asdict(finished).items() if name != "stdout"}


def distortion(original: TexturedMesh, decoded: TexturedMesh, model: Path) -> Record:
    """Every metric of the decoded file as read back."""
    queried = NispModel(unpack(model.read_bytes()))
    report = compare(original, decoded, model=queried)
    return {**report, "pictures": pictures(original, decoded)}


def pictures(original: TexturedMesh, decoded: TexturedMesh) -> dict[str, float]:
    """Mean PSNR and SSIM over the fixed views."""
    frame, around = frame_of(original), turntable(VIEWS)
    drawn = (render_views(mesh, around, frame=frame) for mesh in (original, decoded))
    pairs = zip(*drawn, strict=True)
    views = [compare_pictures(*map(on_white, pair)) for pair in pairs]
    return {name: float(np.mean([view[name] for view in views])) for name in views[0]}


def table(records: dict[str, Record]) -> str:
    """Asked against measured, one line a number."""
    lines = [f"{'asset':<18}{'what':<26}{'asked':>14}{'measured':>14}"]
    for asset, record in records.items():
        if "failure" in record:
            lines.append(f"{asset:<18}FAILED: {record['failure']}")
            continue
        lines += [Asked(asset, target, record).line() for target in targets(asset)]
    return "\n".join(lines)


def attempt(source: Path, keep: Path | None, preset: str, seed: int) -> Record:
    """The record of one asset, or of how it failed: one failure must not stop the rest."""
    try:
        if keep is not None:
            keep.mkdir(parents=True, exist_ok=True)
            return measure(source, keep, preset, seed)
        with tempfile.TemporaryDirectory() as folder:
            return measure(source, Path(folder), preset, seed)
    except Exception as error:
        return {"commit": commit(), "failure": f"{type(error).__name__}: {error}"}


def of_seed(results: Record, seed: int) -> dict[str, Record]:
    """The records of one seed, to be added to: changes `results` where there are none yet."""
    if seed == 0:
        records: dict[str, Record] = results.setdefault("assets", {})
        return records
    records = results.setdefault("seeds", {}).setdefault(str(seed), {})
    return records


def store(path: Path, results: Record) -> None:
    """Write all results so far, whole or not at all."""
    write_result(path, {**results, "machine": machine(), "versions": versions()})


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset; may be repeated.")
@click.option("--again", is_flag=True, help="Measure assets that have a result already.")
@click.option("--preset", default="balanced", show_default=True)
@click.option("--seed", default=0, show_default=True)
@click.option("--keep", type=click.Path(path_type=Path), help="Leave .nisp and .glb files here.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(
    assets: Path,
    only: tuple[str, ...],
    again: bool,
    preset: str,
    seed: int,
    keep: Path | None,
    output: Path,
) -> None:
    """Run the main job on every asset and print asked against measured."""
    results = result_so_far(output)
    records = of_seed(results, seed)
    for source in sorted(assets.glob("*/*.obj")):
        name = source.stem
        done = name in records and "failure" not in records[name]
        if (only and name not in only) or (done and not again):
            continue
        click.echo(f"{name} ...", err=True)
        records[name] = attempt(source, keep, preset, seed)
        store(output, results)
        click.echo(table({name: records[name]}), err=True)
    click.echo(table(records))


if __name__ == "__main__":
    main()
