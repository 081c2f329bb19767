"""Sphere-traced models against their originals: how near the pictures are, and what they cost.

    python -m benchmarks.headline.pictures --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME. Results are kept asset by asset; one that has a result for
the same bytes is not measured again. Where others use the machine, compare processor seconds.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.likeness import likeness as alike
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.process import run
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from benchmarks.paper.published import VIEWS as PUBLISHED
from nispcodec.core.arrays import Float32Array
from nispcodec.io.load import load_mesh
from nispcodec.model import NispModel
from nispcodec.render.camera import turntable
from nispcodec.render.fragments import Scene
from nispcodec.render.maps import Maps
from nispcodec.render.picture import Eye
from nispcodec.render.views import on_white, render_views, scene_of

RESULTS = Path("benchmarks/results/pictures.json")
NISP = Path(sys.executable).with_name("nisp")
VIEWS, SIZE = 8, 512
SILHOUETTES = 2
# Of the decoded mesh whose silhouette is compared: pixels at SIZE are as large.
RESOLUTION = 512
PRECISE = ("spot", "food_apple_01", "chess_king")

TARGETS = {
    "": [
        Target("rays lost", ("silhouette", "lost"), 1e-3),
        Target("missed, of its own mesh", ("silhouette", "missed_of_decoded"), 1e-3),
    ],
    "precise": [
        Target("PSNR, dB", ("pictures", "psnr"), 33, at_least=True),
        Target("SSIM", ("pictures", "ssim"), 0.97, at_least=True),
    ],
    "spot": [
        Target("512: seconds", ("cost", "512", "seconds"), 6),
        Target("512: bytes", ("cost", "512", "peak_bytes"), 600e6),
        Target("1024: seconds", ("cost", "1024", "seconds"), 20),
    ],
}


def targets(asset: str) -> list[Target]:
    """What is asked of an asset."""
    kinds = ["", "precise" if asset in PRECISE else "", asset]
    return [each for kind in dict.fromkeys(kinds) for each in TARGETS.get(kind, [])]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], targets)


def likeness(original: Scene, model: Scene) -> Record:
    """Mean over VIEWS pictures on white, SIZE wide; MSE of 8-bit values, as the paper gives it."""
    views = turntable(VIEWS)
    drawn = (map(on_white, render_views(scene, views, SIZE)) for scene in (original, model))
    found = [_compared(*pair) for pair in zip(*drawn, strict=True)]
    return {name: float(np.mean([each[name] for each in found])) for name in found[0]}


def _compared(first: Float32Array, second: Float32Array) -> dict[str, float]:
    squares = (first.astype(np.float64) - second) ** 2
    covered = (np.minimum(first, second) < 1).any(axis=2)
    of_covered = float(-10 * np.log10(max(squares[covered].mean(), 1e-20)))
    return {**alike(first, second), "psnr_of_covered": of_covered}


def silhouette(original: Scene, decoded: Scene, model: Scene) -> Record:
    """Rays that hit a mesh and not the field or the other way, as shares of those that hit.

    `decoded` is the mesh that the model decodes to: the same field, found by another method.
    """
    counts = dict.fromkeys(("missed", "added", "missed_of_decoded", "added_to_decoded", "lost"), 0)
    hits = 0
    for view in turntable(SILHOUETTES):
        theirs, own, ours = (
            Eye(scene, Maps(scene.textures), view, SIZE).pixels()
            for scene in (original, decoded, model)
        )
        seen, again, hit = (np.isfinite(each.distances) for each in (theirs, own, ours))
        hits += int(seen.sum())
        counts["missed"] += int((seen & ~hit).sum())
        counts["added"] += int((hit & ~seen).sum())
        counts["missed_of_decoded"] += int((again & ~hit).sum())
        counts["added_to_decoded"] += int((hit & ~again).sum())
        counts["lost"] += int(ours.lost.sum())
    return {name: count / hits for name, count in counts.items()}


def cost(model: Path) -> Record:
    """`nisp render` as a whole process, at SIZE and twice that: color, from the default view."""
    found = {}
    for size in (SIZE, 2 * SIZE):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.png"
            done = run([NISP, "render", model, "-o", out, "--size", str(size)], Path(folder))
        found[str(size)] = {
            "seconds": done.seconds,
            "processor_seconds": done.cpu_seconds,
            "peak_bytes": done.peak_bytes,
            "load": os.getloadavg()[0],
        }
    return found


def measure(path: Path, source: Path) -> Record:
    """Everything about one asset."""
    model: NispModel = nispcodec.load(path)
    original = scene_of(load_mesh(source), model.document.frame)
    field = scene_of(model)
    decoded = scene_of(model.to_mesh(RESOLUTION), model.document.frame)
    return {
        "pictures": likeness(original, field),
        "silhouette": silhouette(original, decoded, field),
        "cost": cost(path),
    }


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every NAME.nisp in MODELS and print asked against measured."""
    for name, record in measured(
        models, assets, only, output, measure, paper=PUBLISHED["ours"]
    ).items():
        for part in ("pictures", "silhouette"):
            values = ", ".join(f"{key} {value:.4g}" for key, value in record[part].items())
            click.echo(f"{name:<18}{part}: {values}")
        for target in targets(name):
            click.echo(target.line(name, record))


if __name__ == "__main__":
    main()
