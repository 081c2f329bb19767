"""What a decode writes by default, beside every triangle of its grid: faces, bytes, distances.

    python -m benchmarks.studies.decoded_files --models DIR --assets DIR [--only sample]

DIR holds NAME.nisp of fields. The demo's asset is of `nisp sample -o DIR/sample`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec.core.asset import TexturedMesh
from nispcodec.extract.meshing import default_resolution
from nispcodec.io.load import load_mesh
from nispcodec.io.write.glb import glb_bytes
from nispcodec.io.write.gltf_compression import COMPRESSIONS
from nispcodec.metrics.compare import Reference

RESULTS = Path("benchmarks/results/decoded_files.json")
FEW = 5000
NEEDLE = 100
"""Square of the longest side over the area."""
DISTANCE = Target("distance", ("geometry", "larger", "mean"), 0)
SHARED = [
    Target("distance: default / grid", ("ratios", "distance"), 1.1),
    Target("processor time: default / grid", ("ratios", "seconds"), 1.2),
    Target(f"needles at {FEW} faces", ("few", "needles"), 0),
]
DEMO = [
    Target("faces", ("default", "faces"), 60_000),
    Target("bytes", ("default", "bytes"), 3_000_000),
    Target("bytes, meshopt", ("default", "meshopt"), 1_000_000),
]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(
        results["assets"], lambda name: SHARED + (DEMO if name == "sample" else [])
    )


def needles(mesh: TexturedMesh) -> int:
    """How many triangles are long and thin."""
    a, b, c = mesh.corners.transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    longest = np.max([((one - other) ** 2).sum(1) for one, other in ((a, b), (b, c), (c, a))], 0)
    return int((longest > NEEDLE * areas).sum())


def decoded(reference: Reference, make: Callable[[], TexturedMesh]) -> Record:
    """A mesh and its GLB: processor time of both, counts, bytes, distance to the original."""
    seconds = []
    for _ in range(2):
        start = time.process_time()
        mesh = make()
        size = len(glb_bytes(mesh))
        seconds.append(time.process_time() - start)
    distance = DISTANCE.measured(reference.compare(mesh))
    counts = {"faces": len(mesh.faces), "needles": needles(mesh), "bytes": size}
    packed = {how: len(glb_bytes(mesh, compress=how)) for how in COMPRESSIONS}
    return {**counts, **packed, "distance": distance, "seconds": min(seconds)}


def measure(path: Path, source: Path) -> Record:
    """One asset: all triangles of the grid, the default, and a few."""
    model, reference = nispcodec.load(path), Reference.of(load_mesh(source))
    field = field_of(model.document)
    cells = default_resolution(field.sdf, field.half_thickness)
    # Imports are not to count.
    model.to_mesh(32, faces=100)
    found = {
        "grid": decoded(reference, lambda: model.to_mesh(cells)),
        "default": decoded(reference, model.to_mesh),
        "few": decoded(reference, lambda: model.to_mesh(faces=FEW)),
    }
    images = sum(len(each.data) for each in model.document.textures)
    ratios = {
        name: found["default"][name] / found["grid"][name]
        for name in ("faces", "bytes", "distance", "seconds")
    }
    return {"cells": cells, "images": images, **found, "ratios": ratios}


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every NAME.nisp in MODELS and print asked against measured."""
    records = measured(models, assets, only, output, measure)
    for each in asked({"assets": records}):
        click.echo(each.line())


if __name__ == "__main__":
    main()
