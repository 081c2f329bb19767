"""Cracks, duplicate vertices and triangles across two charts in plain decodes: all must be 0.

python -m benchmarks.studies.soundness MODEL.nisp ... [-o OUT.json]
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

from benchmarks.measuring.field_of import field_of
from benchmarks.measuring.result_file import write_result
from nispcodec.core.arrays import BoolArray, Float32Array, Int32Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.extract.meshing import textured_mesh
from nispcodec.format import unpack
from nispcodec.infer.evaluate import classify
from nispcodec.infer.field import FieldQueries

# UVs are told apart by more than what rounding positions to the world frame and back can do.
SAME_UV = 1e-3


def soundness(document: Document, mesh: TexturedMesh) -> dict[str, int]:
    """What must be 0 on a mesh decoded from the document; and its faces.

    Cracks are edges without a face on the other side; crowded edges have more than two faces.
    """
    faces = mesh.faces.astype(np.int64)
    edges = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    forth, back = (np.unique(edges @ weights) for weights in ([1 << 32, 1], [1, 1 << 32]))
    return {
        "faces": len(faces),
        "cracks": len(np.setdiff1d(forth, back)),
        "crowded_edges": len(edges) - len(forth),
        "duplicate_vertices": len(mesh.positions) - len(np.unique(mesh.positions, axis=0)),
        "two_chart_triangles": two_chart_triangles(document, mesh),
    }


def two_chart_triangles(document: Document, mesh: TexturedMesh) -> int:
    """Triangles whose three UVs are no single chart's, asked of the networks anew."""
    field = field_of(document)
    if field.uv is None:
        return 0
    points = document.frame.to_normalized(mesh.positions).astype(np.float32)
    left = np.flatnonzero(mesh.has_uv)
    if field.chart is not None:
        middles = points[mesh.faces[left]].mean(axis=1, dtype=np.float32)
        left = left[~_agrees(document, mesh, points, left, classify(field.chart, middles))]
    for chart in range(len(field.charts)):
        charts = np.full(len(left), chart, np.int32)
        left = left[~_agrees(document, mesh, points, left, charts)]
    return len(left)


def _agrees(
    document: Document,
    mesh: TexturedMesh,
    points: Float32Array,
    faces: Int64Array,
    charts: Int32Array,
) -> BoolArray:
    """Whether all corners of each face (f,) have the UVs that its chart gives them."""
    corners = points[mesh.faces[faces]].reshape(-1, 3)
    expected = FieldQueries(field_of(document)).uv(corners, np.repeat(charts, 3)).reshape(-1, 3, 2)
    difference = np.abs(mesh.uvs[mesh.uv_faces[faces]] - expected)
    return np.asarray((difference < SAME_UV).all(axis=(1, 2)))


def counted(document: Document) -> dict[str, int]:
    """The counts for a plain decode, and what was dropped as noise.

    Membranes across the asset's openings are left in, as the rims that they leave are no cracks.
    """
    field = field_of(document)
    closed = replace(document, field=replace(field, charts=replace(field.charts, openings=False)))
    mesh, report = textured_mesh(closed)
    counts = soundness(closed, mesh)
    return {"resolution": report.resolution, **counts, "dropped_components": report.dropped}


@click.command()
@click.argument("models", nargs=-1, required=True, type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(models: tuple[Path, ...], output: Path | None) -> None:
    """Count what must be 0 in plain decodes of MODELS."""
    record = {}
    for model in models:
        record[model.stem] = counted(unpack(model.read_bytes()))
        click.echo(f"{model.stem}: {json.dumps(record[model.stem])}")
    if output is not None:
        write_result(output, record)


if __name__ == "__main__":
    main()
