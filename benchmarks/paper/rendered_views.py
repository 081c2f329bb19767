"""Table 3 of the paper with every preset of ours: rendered views, and the bytes they take.

    python -m benchmarks.paper.rendered_views --models DIR --assets ../shared/assets [--only spot]

DIR holds PRESET/NAME.nisp, as `nisp encode --preset PRESET` writes the assets NAME. Each is sphere-
traced, or its triangles are hit by rays, beside the original: without light, as the paper shows
base colors, and lit. A model that has a result for the same bytes is not measured again.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from hashlib import sha256
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.likeness import mean_likeness
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result
from benchmarks.measuring.target import Asked, Target
from benchmarks.paper.published import VIEWS as PUBLISHED
from benchmarks.paper.unlit import unlit_mesh, unlit_model
from nispcodec.core.asset import TexturedMesh
from nispcodec.encode.config import PRESETS
from nispcodec.format import own_bytes
from nispcodec.io.load import load_mesh
from nispcodec.model import NispModel
from nispcodec.render.camera import turntable
from nispcodec.render.views import on_white, render_views, scene_of

RESULTS = Path("benchmarks/results/paper_rendered_views.json")
VIEWS, SIZE = 4, 512
KINDS = ("unlit", "lit")
TARGETS = [
    Target("PSNR, dB", ("psnr",), PUBLISHED["ours"]["psnr"], at_least=True),
    Target("SSIM", ("ssim",), PUBLISHED["ours"]["ssim"], at_least=True),
]
LIT = Target("PSNR of lit views, dB", ("psnr",), 42, at_least=True)
"""Asked of `best` alone, by ourselves."""


def asked(results: Record) -> Iterator[Asked]:
    """The published numbers, asked of each preset's mean, unlit; and our own of `best`."""
    for preset, assets in results["presets"].items():
        mean = means(assets.values())
        yield from (Asked(preset, target, mean["unlit"]) for target in TARGETS)
        if preset == "best":
            yield Asked(preset, LIT, mean["lit"])


def means(records: Iterable[Record]) -> dict[str, Record]:
    """By kind, the means of all numbers over assets."""
    listed = list(records)
    return {
        kind: {name: float(np.mean([each[kind][name] for each in listed])) for name in found}
        for kind, found in ((kind, listed[0][kind]) for kind in KINDS)
    }


def measure(path: Path, source: Path) -> Record:
    """Bytes and likeness of a model to its original."""
    mesh, model, data = load_mesh(source), nispcodec.load(path), path.read_bytes()
    forms = {"networks": model.document.field, "triangles": model.document.meshes}
    return {
        "commit": commit(),
        "model": sha256(data).hexdigest(),
        "held_as": " and ".join(form for form, there in forms.items() if there),
        "bytes": {"geometry_uv": own_bytes(data), "total": len(data)},
        "unlit": alike(unlit_mesh(mesh), unlit_model(model)),
        "lit": alike(mesh, model),
    }


def alike(mesh: TexturedMesh, model: NispModel) -> dict[str, float]:
    """Means over the views, on white."""
    original, views = scene_of(mesh, model.document.frame), turntable(VIEWS)
    drawn = (map(on_white, render_views(each, views, SIZE)) for each in (original, model))
    return mean_likeness(*drawn)


def models_in(folder: Path, only: tuple[str, ...]) -> Iterator[tuple[str, Path]]:
    """Presets and their files, asset by asset."""
    for preset in PRESETS:
        for path in sorted((folder / preset).glob("*.nisp")):
            if not only or path.stem in only:
                yield preset, path


def line(preset: str, name: str, record: Record) -> str:
    """A model's line of the table."""
    size, held = record["bytes"]["geometry_uv"], record["held_as"]
    numbers = "  ".join(
        f"{kind} {record[kind]['psnr']:.2f} dB, SSIM {record[kind]['ssim']:.4f}" for kind in KINDS
    )
    return f"{preset:<10}{name:<18}{size:>8,} B  {numbers}  {held}"


@click.command()
@click.option("--models", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--only", multiple=True, help="An asset; may be repeated.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every PRESET/NAME.nisp in MODELS, and print asked against measured."""
    presets: dict[str, dict[str, Record]] = result_so_far(output).get("presets", {})
    for preset, path in models_in(models, only):
        found = presets.setdefault(preset, {})
        if found.get(path.stem, {}).get("model") != sha256(path.read_bytes()).hexdigest():
            found[path.stem] = measure(path, assets / path.stem / f"{path.stem}.obj")
            click.echo(line(preset, path.stem, found[path.stem]))
            ordered = {name: presets[name] for name in PRESETS if name in presets}
            how = {"views": VIEWS, "size": SIZE, "published": PUBLISHED["ours"]}
            write_result(
                output,
                {"machine": machine(), "versions": versions(), **how, "presets": ordered},
            )
    for each in asked({"presets": presets}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
