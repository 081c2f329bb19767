"""Whole assets with their images, at equal rendered PSNR: ours against simplify + Draco.

    nisp encode ASSET -o DIR/NAME.nisp --target-total SIZE
    python -m benchmarks.headline.totals --models DIR --assets ../shared/assets [--only spot]

The rival has the same images, by the same codec and shares: each of its settings with as many bytes
of images as it needs. Pictures from eight sides, by the same renderer, are compared with those of
the original; ours are of the mesh that the written bytes decode to. Draco is counted without a
container. None has normals: creases are found by angle in all of them, the original too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import click

import nispcodec
from benchmarks.assets.source import Source
from benchmarks.codecs import Setting, simplified_draco
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.asset import TexturedMesh
from nispcodec.encode.compact_images import compact_images
from nispcodec.encode.config import TotalConfig
from nispcodec.encode.image_shares import ImageShares
from nispcodec.encode.total import Pictures
from nispcodec.metrics.psnr import psnr
from nispcodec.render.remembered import RememberedScene
from nispcodec.render.views import scene_of

RESULTS = Path("benchmarks/results/totals.json")
KEPT, BITS = (1.0, 0.7, 0.5, 0.25, 0.125), (11,)
FEWEST = 150
# Image bytes are tried in steps this large.
STEP = 1.03
TARGET = Target("share of Draco's total", ("share",), 0.9)


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda _: [TARGET])


def measure(path: Path, source: Path) -> Record:
    """Our file, and the fewest bytes of the rival at its PSNR; None where it has no such."""
    asset, model = Source(source), nispcodec.load(path)
    pictures = Pictures(replace(asset.mesh, creases=None), TotalConfig())
    ours = pictures.error(_scene(model.to_mesh(), pictures))
    images = sum(len(each.data) for each in model.document.textures)
    total = path.stat().st_size
    rival = draco(asset, pictures, ours, total)
    return {
        "preset": model.document.info["preset"],
        "bytes": total,
        "geometry_share": (total - images) / total,
        "psnr": psnr(ours, 1.0),
        "rival": rival,
        "share": total / rival["bytes"] if rival["bytes"] else None,
    }


def draco(asset: Source, pictures: Pictures, wanted: float, total: int) -> Record:
    """The setting of the fewest bytes whose pictures, drawn with its images, are as good."""
    shares = ImageShares(compact_images(asset.mesh))
    shares.measure(TotalConfig().qualities, 4.0 * total, pictures.error_of_textures)
    found: Record = {"bytes": None}
    for setting in _settings(asset):
        data = simplified_draco.encode(asset, setting)
        scene = _scene(simplified_draco.decode(data, asset), pictures)
        error = pictures.error(scene)
        size = _images_needed(shares, wanted - error, 4.0 * total)
        while size and (textures := shares.fitted(size)):
            used = len(data) + sum(len(each.data) for each in textures)
            if found["bytes"] and used >= found["bytes"]:
                break
            reached = pictures.error(scene.with_textures(textures))
            if reached <= wanted:
                found = {"setting": setting, "geometry": len(data), "bytes": used}
                found["psnr"] = psnr(reached, 1.0)
                break
            size = STEP * size if size < 4 * total else 0.0
    return found


def _settings(asset: Source) -> list[Setting]:
    surfaces = ("all", "outer") if asset.hidden_share > simplified_draco.NOTABLE else ("all",)
    shares = [kept for kept in KEPT if kept * len(asset.mesh.faces) > FEWEST]
    return [
        {"surface": surface, "kept": kept, "qp": bits, "qt": bits}
        for surface in surfaces
        for kept in shares
        for bits in BITS
    ]


def _images_needed(shares: ImageShares, error: float, most: float) -> float:
    """The fewest bytes of images that are expected to lose no more; 0 where none does."""
    size = float(shares.least)
    while size <= most:
        if shares.error(size) <= error:
            return size
        size *= STEP
    return 0.0


def _scene(mesh: TexturedMesh, pictures: Pictures) -> RememberedScene:
    return RememberedScene(scene_of(replace(mesh, creases=None), pictures.frame))


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every NAME.nisp in MODELS and print our share of the rival's bytes."""
    records = measured(models, assets, only, output, measure)
    for name, record in records.items():
        found = f"{record['bytes']:>9,} B {record['psnr']:.2f} dB, rival {record['rival']}"
        click.echo(f"{name:<24}{found}")
    for each in asked({"assets": records}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
