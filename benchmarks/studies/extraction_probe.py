"""One extraction in a process of its own, so that its peak memory can be read: prints JSON.

python -m benchmarks.studies.extraction_probe model.nisp 512
"""

from __future__ import annotations

import json
import time
from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.field_of import field_of
from nispcodec.core.document import Document
from nispcodec.extract.components import without_noise
from nispcodec.extract.grid import CUBE
from nispcodec.extract.isosurface import extract
from nispcodec.extract.meshing import default_resolution, textured_mesh
from nispcodec.format import unpack
from nispcodec.infer.evaluate import evaluate


def sparse(document: Document, resolution: int) -> dict[str, float]:
    """Seconds to the bare surface, without noise, and to the finished textured mesh."""
    started, busy = time.perf_counter(), time.process_time()
    field = field_of(document)
    cells = resolution or default_resolution(field.sdf, field.half_thickness)
    surface, report = without_noise(field.sdf, extract(field.sdf, cells))
    extracted = time.perf_counter() - started
    peak, worked = peak_bytes(), time.process_time() - busy
    started = time.perf_counter()
    mesh, _ = textured_mesh(document, resolution or None)
    return {
        "resolution": report.resolution,
        "seconds": round(extracted, 3),
        "processor_seconds": round(worked, 3),
        "peak_bytes": peak,
        "faces": len(surface.faces),
        "dropped_components": report.dropped,
        "mesh_seconds": round(time.perf_counter() - started, 3),
        "mesh_peak_bytes": peak_bytes(),
        "mesh_faces": len(mesh.faces),
    }


def dense(document: Document, resolution: int) -> dict[str, float]:
    """The same surface as one does without this package's extraction: full grid, skimage."""
    from skimage.measure import marching_cubes

    started = time.perf_counter()
    axis = np.linspace(-CUBE, CUBE, resolution + 1, dtype=np.float32)
    grid = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    values = evaluate(field_of(document).sdf, grid).reshape((resolution + 1,) * 3)
    faces = marching_cubes(values, 0.0)[1]  # type: ignore[no-untyped-call]
    seconds = round(time.perf_counter() - started, 3)
    return {"seconds": seconds, "peak_bytes": peak_bytes(), "faces": len(faces)}


def peak_bytes() -> int:
    """The largest resident size of this process so far; getrusage would answer its parent's."""
    status = Path("/proc/self/status").read_text().splitlines()
    peak = next(line for line in status if line.startswith("VmHWM:"))
    return int(peak.split()[1]) * 1024


@click.command()
@click.argument("model", type=click.Path(path_type=Path, exists=True))
@click.argument("resolution", type=int)
@click.option("--dense", "full", is_flag=True, help="Full grid and skimage instead.")
def main(model: Path, resolution: int, full: bool) -> None:
    """Extract MODEL at RESOLUTION; 0 for what a plain decode takes."""
    document = unpack(model.read_bytes())
    extract(field_of(document).sdf, 16)
    click.echo(json.dumps((dense if full else sparse)(document, resolution)))


if __name__ == "__main__":
    main()
