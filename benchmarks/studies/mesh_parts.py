"""Mesh parts against simplify + Draco: bytes at equal mean distance and mean UV error.

    npm install meshoptimizer@1.3.0
    python -m benchmarks.studies.mesh_parts --assets ../shared/assets

The rival is the better of two: vertices that are a subset, and vertices that move (UV weights 1, 10
and 100), each over a grid of face counts and bits. Of its settings that no other beats in both
bytes and distance some are taken. The rival's bytes are the fewest of all its settings with no
larger distance and UV error than that one; ours the fewest that `best_for` finds within the same.
Where faces are hidden in other bodies, both sides leave them out.

Our bytes are those of `nispcodec.format.mesh`. What the rival reaches is kept in `--points`.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from importlib import import_module
from itertools import product
from pathlib import Path
from time import perf_counter
from typing import Any

import click
import numpy as np

from benchmarks.assets.corners import Corners, corners_of
from benchmarks.assets.simplify import simplified
from benchmarks.assets.simplify_update import missing, simplified_moving
from benchmarks.assets.source import Source, sources
from benchmarks.codecs import draco
from benchmarks.codecs.simplified_draco import FEWEST, NOTABLE
from benchmarks.codecs.simplified_update_draco import UV_WEIGHTS
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from nispcodec.core.arrays import BoolArray
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.mesh_part import MeshPart
from nispcodec.geometry.analysis import normalizing_frame
from nispcodec.simplify.errors import Counted
from nispcodec.simplify.ladder import Candidate, Simplifier
from nispcodec.simplify.search import best_for
from nispcodec.simplify.triangles import Triangles, distinct_corners

KEPT = (0.7, 0.5, 0.35, 0.25, 0.125, 0.0625)
BITS = ((9, 9), (10, 10), (11, 11), (12, 12))
# By the logarithm of bytes, from the rival's largest file to its smallest.
PLACES = (0.3, 0.55, 0.8)
RESULTS = Path("benchmarks/results/mesh_parts.json")

Point = dict[str, Any]


def size(parts: tuple[MeshPart, ...]) -> int:
    """The bytes of parts, as the section of a file."""
    return len(import_module("nispcodec.format.mesh").encode(parts))


def chosen_faces(source: Source) -> BoolArray | None:
    """The faces that can be seen, where notable ones cannot; else None: all."""
    return source.outer_faces if source.hidden_share > NOTABLE else None


def simplifier_of(source: Source) -> Simplifier:
    """Ours, which also measures the rival."""
    triangles = Triangles.of(source.mesh, normalizing_frame(source.mesh))
    chosen = chosen_faces(source)
    kept = None if chosen is None else chosen[distinct_corners(source.mesh)]
    return Simplifier.of(triangles, size, counted=None if kept is None else Counted.of(kept))


def rival_meshes(source: Source) -> Iterator[tuple[str, Corners]]:
    """Every simplified mesh of the rival, and what it is called."""
    corners, total = corners_of(source.mesh, chosen_faces(source)), len(source.mesh.faces)
    yield "all", corners
    for kept in (kept for kept in KEPT if kept * total > FEWEST):
        faces = round(kept * total)
        # None left is no setting of the rival.
        with suppress(ValueError):
            yield f"subset {kept}", simplified(corners, faces)
        for weight in UV_WEIGHTS:
            with suppress(ValueError):
                yield f"update {weight:g} {kept}", simplified_moving(corners, faces, weight)


def rival_points(source: Source, ours: Simplifier) -> list[Point]:
    """Bytes and errors of every setting of the rival."""
    points = []
    for (name, corners), (qp, qt) in product(rival_meshes(source), BITS):
        data = draco.encode_corners(corners, {"qp": qp, "qt": qt})
        errors = ours.original.errors(normalized(source, draco.decode(data, source)))
        measured = {"distance": errors.distance, "uv": errors.uv, "uv_median": errors.uv_median}
        points.append({"setting": f"{name} {qp}/{qt}", "bytes": len(data), **measured})
    return points


def normalized(source: Source, mesh: TexturedMesh) -> TexturedMesh:
    """A mesh in the world frame, brought into the source's normalized frame."""
    return replace(mesh, positions=normalizing_frame(source.mesh).to_normalized(mesh.positions))


def kept_points(source: Source, ours: Simplifier, folder: Path) -> list[Point]:
    """The rival's points from the folder, or measured and put there."""
    path = folder / f"{source.name}.json"
    if not path.exists():
        points = rival_points(source, ours)
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(points), encoding="utf-8")
    found: list[Point] = json.loads(path.read_text(encoding="utf-8"))
    return found


def places(points: list[Point]) -> list[Point]:
    """Settings nearest to PLACES, of those that no other beats in both bytes and distance."""
    front: list[Point] = []
    for point in sorted(points, key=lambda each: (each["bytes"], each["distance"])):
        if not front or point["distance"] < front[-1]["distance"]:
            front.append(point)
    sizes = np.log([point["bytes"] for point in front])
    wanted = sizes.max() - np.asarray(PLACES) * np.ptp(sizes)
    return [front[index] for index in np.abs(sizes[:, None] - wanted).argmin(axis=0)]


def duel(points: list[Point], place: Point, ours: Simplifier) -> Point:
    """The fewest bytes of both sides within the errors of one of the rival's settings."""
    distance, uv = place["distance"], place["uv"]
    good = [each for each in points if each["distance"] <= distance and each["uv"] <= uv]
    rival = min(good, key=lambda each: each["bytes"])
    start = perf_counter()
    best = best_for(ours, distance, uv)
    seconds = round(perf_counter() - start, 2)
    return {
        "distance": distance,
        "uv": uv,
        "rival": rival,
        "ours": shown(best),
        "seconds": seconds,
        "ratio": None if best is None else round(best.size / rival["bytes"], 3),
    }


def shown(best: Candidate | None) -> Point | None:
    """A candidate in numbers."""
    if best is None:
        return None
    errors = best.errors
    return {
        "bytes": best.size,
        "faces": best.faces,
        "bits": best.bits,
        "uv_bits": best.uv_bits,
        "distance": errors.distance,
        "uv": errors.uv,
        "uv_median": errors.uv_median,
    }


def means(table: dict[str, list[Point]]) -> dict[str, Any]:
    """Geometric means of the ratios: of each asset's, and of these."""
    ratios = {name: [each["ratio"] for each in found] for name, found in table.items()}
    found = {name: geometric_mean([each for each in some if each]) for name, some in ratios.items()}
    return {"means": found, "mean": geometric_mean(list(found.values()))}


def geometric_mean(ratios: list[float]) -> float:
    """The geometric mean of ratios above 0."""
    return round(float(np.exp(np.mean(np.log(ratios)))), 3)


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--asset", "names", multiple=True, help="Only these.")
@click.option("--points", type=click.Path(path_type=Path), default="build/mesh_parts")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(assets: Path, names: tuple[str, ...], points: Path, output: Path) -> None:
    """Print a line for every comparison and write all as JSON."""
    reason = missing()
    if reason is not None:
        raise click.ClickException(reason)
    table: dict[str, list[Point]] = {}
    for source in sources(assets):
        if names and source.name not in names:
            continue
        ours = simplifier_of(source)
        rivals = kept_points(source, ours, points)
        table[source.name] = []
        for place in places(rivals):
            table[source.name].append(duel(rivals, place, ours))
            click.echo(f"{source.name:<24}{table[source.name][-1]}")
        write_result(output, {"commit": commit(), "assets": table, **means(table)})
    click.echo(means(table))


if __name__ == "__main__":
    main()
