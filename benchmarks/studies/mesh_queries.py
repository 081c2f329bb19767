"""Signed distances a second from a mesh part of 5,000 triangles, by the kernel and by numpy.

    python -m benchmarks.studies.mesh_queries [--seconds 5] [--write benchmarks/results/NAME.json]

The mesh is a bumpy torus. Points are uniform in the cube [-1, 1]^3, or off the surface by NEAR of
the radius, normally distributed. All cores work, and the fastest turn of each counts: others on the
machine make a turn longer, never shorter. `core` is by the time that processors worked on a turn,
all together: what one core alone does, whatever else the machine has to do.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, as_json, write_result
from benchmarks.measuring.target import Asked, Target
from nispcodec.core.arrays import Float32Array, Int32Array
from nispcodec.core.mesh_part import MeshPart
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.infer.mesh_search import SearchConfig
from nispcodec.infer.native.mesh_kernel import KERNEL

AROUND, ACROSS, BITS, NEAR = 50, 50, 12, 0.01
POINTS = {"kernel": 200_000, "numpy": 10_000}


def asked(results: Record) -> Iterator[Asked]:
    """Half a million queries a second with the kernel, of one core alone."""
    for name, found in results["points"].items():
        yield Asked(name, Target("queries/s", ("kernel", "core"), 0.5e6, at_least=True), found)


@click.command()
@click.option("--seconds", default=5.0, help="That the turns of each take.")
@click.option("--write", type=click.Path(path_type=Path), help="The result file.")
def main(seconds: float, write: Path | None) -> None:
    """Print queries a second, and asked against measured."""
    part = torus()
    found = {name: measured(part, name, seconds) for name in ("in the cube", "near the surface")}
    result = {
        "commit": commit(),
        "machine": machine(),
        "versions": versions(),
        "instructions": next(iter(KERNEL.available()), "none"),
        "triangles": len(part.faces),
        "points": found,
    }
    if write:
        write_result(write, result)
    print(as_json(result))
    for each in asked(result):
        print(each.line())


def measured(part: MeshPart, where: str, seconds: float) -> Record:
    """Queries a second at such points, by engine."""
    engines = {"kernel": SearchConfig(), "numpy": SearchConfig(kernel=False)}
    return {
        name: speed(PlacedMeshes((part,), config), some_points(part, where, POINTS[name]), seconds)
        for name, config in engines.items()
    }


def speed(meshes: PlacedMeshes, points: Float32Array, seconds: float) -> dict[str, int]:
    """Queries a second: on all cores, and of one core."""
    taken, spent = np.inf, np.inf
    ends = time.monotonic() + seconds
    while time.monotonic() < ends or not np.isfinite(taken):
        start, busy = time.perf_counter(), time.process_time()
        meshes.sdf(points)
        taken = min(taken, time.perf_counter() - start)
        spent = min(spent, time.process_time() - busy)
    return {"all_cores": round(len(points) / taken), "core": round(len(points) / spent)}


def some_points(part: MeshPart, where: str, count: int) -> Float32Array:
    """(count, 3) in the normalized frame."""
    rng = np.random.default_rng(0)
    if where == "in the cube":
        return rng.uniform(-1, 1, (count, 3)).astype(np.float32)
    corners = part.normalized()[part.faces[rng.integers(0, len(part.faces), count)]]
    on_it = (rng.dirichlet((1, 1, 1), count)[:, :, None] * corners).sum(axis=1)
    return (on_it + rng.normal(0, NEAR, (count, 3))).astype(np.float32)


def torus() -> MeshPart:
    """A bumpy torus within the unit ball, of 2 * AROUND * ACROSS triangles."""
    around, across = np.meshgrid(np.arange(AROUND), np.arange(ACROSS), indexing="ij")
    turn, roll = 2 * np.pi * around / AROUND, 2 * np.pi * across / ACROSS
    thick = 0.3 * (1 + 0.2 * np.sin(5 * turn) * np.sin(3 * roll))
    out = 0.6 + thick * np.cos(roll)
    points = np.stack([out * np.cos(turn), out * np.sin(turn), thick * np.sin(roll)], axis=2)
    step = 2 / 2**BITS
    grid = np.rint((points.reshape(-1, 3) + 1) / step).astype(np.int32)
    faces = torus_faces()
    return MeshPart(
        positions=grid,
        faces=faces,
        uvs=grid[:, :2],
        uv_faces=faces,
        face_charts=np.zeros(len(faces), np.int32),
        chart_materials=np.zeros(1, np.int32),
        chart_has_uv=np.ones(1, np.bool_),
        creases=np.zeros(faces.shape, np.bool_),
        sheet=np.zeros(len(faces), np.bool_),
        step=step,
        origin=(-1.0, -1.0, -1.0),
    )


def torus_faces() -> Int32Array:
    """(2 * AROUND * ACROSS, 3), looking outwards."""
    here = np.arange(AROUND * ACROSS, dtype=np.int32).reshape(AROUND, ACROSS)
    on, up = np.roll(here, -1, axis=0), np.roll(here, -1, axis=1)
    both = np.roll(on, -1, axis=1)
    halves = [
        np.stack(each, axis=2).reshape(-1, 3) for each in ((here, on, both), (here, both, up))
    ]
    return np.concatenate(halves).reshape(-1, 3)


if __name__ == "__main__":
    main()
