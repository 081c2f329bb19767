"""Copies held once: a scene of 33 bodies of 6 shapes against simplify + Draco.

    python -m benchmarks.studies.copies [--across 52]

The rival is coded over a grid of face counts and bits. Of its settings that no other beats in both
bytes and distance some are taken; its bytes are the fewest of all settings with no larger distance
and UV error, ours the fewest that `best_for` finds within the same, with copies and without. The
scene is of our own making, written as GLB and read again, as any asset is. Both sides leave out the
faces that are hidden, as an encode finds them.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import suppress
from itertools import product
from pathlib import Path

import click

from benchmarks.assets.corners import Corners, corners_of
from benchmarks.assets.pieces import scene
from benchmarks.assets.simplify import simplified
from benchmarks.assets.source import Source
from benchmarks.codecs import draco
from benchmarks.codecs.simplified_draco import FEWEST
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from benchmarks.studies.mesh_parts import (
    Point,
    duel,
    geometric_mean,
    normalized,
    places,
)
from nispcodec.core.arrays import BoolArray
from nispcodec.core.progress import silent
from nispcodec.encode.config import FormConfig
from nispcodec.encode.mesh_form import MeshForm
from nispcodec.geometry.analysis import Analysis, analyze
from nispcodec.geometry.shown import shown
from nispcodec.simplify.config import CopiesConfig, LadderConfig
from nispcodec.simplify.ladder import Simplifier

KEPT = (0.5, 0.25, 0.125, 0.0625, 0.044, 0.031, 0.022)
BITS = ((9, 9), (10, 10), (11, 11), (12, 12))
RESULTS = Path("benchmarks/results/copies.json")
ASKED, AIM = 0.5, 0.25
NONE = CopiesConfig(fewest=2**31)


def simplifier_of(analysis: Analysis, copies: CopiesConfig) -> Simplifier:
    """Ours, as an encode has it; it also measures the rival."""
    forms = FormConfig(ladder=LadderConfig(copies=copies))
    return MeshForm(analysis, 0, forms, silent).simplifier


def rival_meshes(source: Source, chosen: BoolArray) -> Iterator[tuple[str, Corners]]:
    """Every simplified mesh of the chosen faces (m,) bool, and what it is called."""
    corners, total = corners_of(source.mesh, chosen), len(source.mesh.faces)
    yield "all", corners
    for kept in (kept for kept in KEPT if kept * total > FEWEST):
        # None left is no setting of the rival.
        with suppress(ValueError):
            yield f"subset {kept}", simplified(corners, round(kept * total))


def rival_points(source: Source, chosen: BoolArray, ours: Simplifier) -> list[Point]:
    """Bytes and errors of every setting of the rival."""
    points = []
    for (name, corners), (qp, qt) in product(rival_meshes(source, chosen), BITS):
        data = draco.encode_corners(corners, {"qp": qp, "qt": qt})
        errors = ours.original.errors(normalized(source, draco.decode(data, source)))
        measured = {"distance": errors.distance, "uv": errors.uv, "uv_median": errors.uv_median}
        points.append({"setting": f"{name} {qp}/{qt}", "bytes": len(data), **measured})
    return points


@click.command()
@click.option("--across", default=52, show_default=True, help="Columns of quads of a piece.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(across: int, output: Path) -> None:
    """Print a line for every comparison and write all as JSON."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pieces.glb"
        scene(across).save(path)
        source = Source(path)
        analysis = analyze(source.mesh)
        ours, whole = simplifier_of(analysis, CopiesConfig()), simplifier_of(analysis, NONE)
        points = rival_points(source, shown(analysis).faces, ours)
    rows = []
    for place in places(points):
        with_copies, without = duel(points, place, ours), duel(points, place, whole)
        rows.append({**with_copies, "without_copies": without["ours"]})
        click.echo(rows[-1])
    ratio = geometric_mean([row["ratio"] for row in rows])
    result = {
        "commit": commit(),
        "faces": len(source.mesh.faces),
        "held_faces": len(ours.source.triangles),
        "placements": [len(group.placements) for group in ours.copies.groups],
        "rows": rows,
        "ratio": ratio,
        "asked": ASKED,
        "aim": AIM,
    }
    write_result(output, result)
    click.echo(f"{ratio} of the rival's bytes; asked {ASKED}, aim {AIM}")


if __name__ == "__main__":
    main()
