"""What networks and grids answer for distance, against the mesh that was encoded.

python -m benchmarks.studies.sdf_grid ASSET.obj MODEL.nisp ... [-o OUT.json]

Points are uniform in balls around the asset. Errors are those of the distance without its sign,
normalized frame: an original may be open, and then has no side.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from nispcodec.core.arrays import Float32Array, Float64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Frame
from nispcodec.extract.decoded_distance import DecodedDistance
from nispcodec.infer.mesh_search import MeshSearch
from nispcodec.model import NispModel

POINTS = 20_000
NEAR = 0.01
# Inner and outer radius of the points.
RANGES = {"ball": (0.0, 1.0), "1 to 1.3": (1.0, 1.3), "1.3 to 1.73": (1.3, 1.73)}


def measured(mesh: TexturedMesh, model: NispModel) -> dict[str, dict[str, float]]:
    """For each range of radii the mean and largest errors of both, and microseconds a point."""
    document = model.document
    surface = _surface_of(mesh, document.frame)
    grid = DecodedDistance(document)

    def network(points: Float64Array) -> Float32Array:
        return model.sdf(points.astype(np.float32), "normalized")

    return {
        name: _errors(_points(*ends), surface, {"network": network, "grid": grid})
        for name, ends in RANGES.items()
    }


def _errors(
    points: Float64Array,
    surface: MeshSearch,
    answers: dict[str, Callable[[Float64Array], Float32Array]],
) -> dict[str, float]:
    true = np.sqrt(surface.closest(points)[1])
    found: dict[str, float] = {"near": int((true < NEAR).sum())}
    for name, answer in answers.items():
        started = time.process_time()
        values = answer(points)
        found[f"{name}_us"] = (time.process_time() - started) / len(points) * 1e6
        errors = np.abs(np.abs(values) - true)
        found[f"{name}_mean"], found[f"{name}_max"] = float(errors.mean()), float(errors.max())
        found[f"{name}_mean_near"] = float(errors[true < NEAR].mean()) if found["near"] else 0.0
        found[f"{name}_inside"] = float((values < 0).mean())
    return {name: round(value, 6) for name, value in found.items()}


def _points(inner: float, outer: float) -> Float64Array:
    random = np.random.default_rng(0)
    ways = random.normal(size=(POINTS, 3))
    radii = random.uniform(inner**3, outer**3, POINTS) ** (1 / 3)
    points: Float64Array = ways / np.linalg.norm(ways, axis=1, keepdims=True) * radii[:, None]
    return points


def _surface_of(mesh: TexturedMesh, frame: Frame) -> MeshSearch:
    corners: Float64Array = frame.to_normalized(mesh.corners.reshape(-1, 3)).reshape(-1, 3, 3)
    return MeshSearch(corners, np.ones(len(corners), np.bool_))


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(files: tuple[Path, ...], output: Path | None) -> None:
    """Measure pairs of FILES: the mesh that was encoded, and the .nisp file."""
    record = {}
    for mesh, model in zip(files[::2], files[1::2], strict=True):
        record[model.stem] = measured(nispcodec.load_mesh(mesh), nispcodec.load(model))
        click.echo(f"{model.stem}: {json.dumps(record[model.stem], indent=1)}")
    if output is not None:
        write_result(output, {"commit": commit(), "points": POINTS, "assets": record})


if __name__ == "__main__":
    main()
