"""Bytes and decode time of triangles on integer grids: our MESH, Draco, meshoptimizer with zstd.

    python -m benchmarks.studies.mesh_codings --assets ../shared/assets
        [-o benchmarks/results/mesh_codings.json]

Each asset is simplified to shares of its faces; meshes of 100 to 6,000 faces count. All three code
the same faces, positions and UVs of as many bits. Ours keeps which faces share a vertex; Draco's
and meshoptimizer's meshes have one vertex for each distinct corner. Seconds are of the processor.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from math import exp, log
from pathlib import Path

import click
import DracoPy
import numpy as np

from benchmarks.assets.corners import Corners, corners_of
from benchmarks.assets.simplify import simplified
from benchmarks.assets.source import Source, sources
from benchmarks.codecs import Setting, draco, meshopt
from benchmarks.codecs.meshopt import on_grid
from benchmarks.measuring.machine import commit, machine
from benchmarks.measuring.result_file import Record, write_result
from nispcodec.core.arrays import Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components, edge_ids, row_ids
from nispcodec.core.mesh_part import MeshPart
from nispcodec.format import mesh

SHARES = (0.06, 0.18, 0.5, 1.0)
FACES = (100, 6000)
SETTINGS: tuple[Setting, ...] = ({"qp": 8, "qt": 9}, {"qp": 10, "qt": 10}, {"qp": 12, "qt": 11})


def without_slivers(corners: Corners) -> Corners:
    """Without faces that have a position twice. Raises ValueError when none are left."""
    places = row_ids(corners.positions)[corners.faces]
    apart = (places != np.roll(places, 1, axis=1)).all(axis=1)
    if not apart.any():
        raise ValueError("expected a face with three positions, found none")
    return corners.only(corners.faces[apart].ravel())


def part_of(corners: Corners, setting: Setting) -> MeshPart:
    """The same mesh as a part: equal positions are one vertex, charts end where UVs do."""
    places = row_ids(corners.positions)
    positions, (*_, step) = on_grid(corners.positions, int(setting["qp"]))
    uvs, (*_, uv_step) = on_grid(corners.uvs, int(setting["qt"]))
    pairs = row_ids(uvs)
    faces = places[corners.faces]
    materials = corners.materials[corners.faces[:, 0]]
    charts = _charts(faces, pairs[corners.faces], materials)
    count = len(faces)
    return MeshPart(
        positions=positions[np.unique(places, return_index=True)[1]],
        faces=faces.astype(np.int32),
        uvs=uvs[np.unique(pairs, return_index=True)[1]],
        uv_faces=pairs[corners.faces].astype(np.int32),
        face_charts=charts,
        chart_materials=materials[np.unique(charts, return_index=True)[1]].astype(np.int32),
        chart_has_uv=np.ones(int(charts.max()) + 1, np.bool_),
        creases=np.zeros((count, 3), np.bool_),
        sheet=np.zeros(count, np.bool_),
        step=step,
        uv_step=(uv_step, uv_step),
    )


def _charts(faces: Int64Array, uvs: Int64Array, materials: Int32Array) -> Int32Array:
    """(m,): faces that edges connect at which UVs and materials go on."""
    ways, sides = edge_ids(faces)[1], np.arange(faces.size)
    after = np.roll(faces, -1, axis=1).ravel()
    ends = np.stack([faces.ravel(), after], axis=1)
    textures = np.stack([uvs.ravel(), np.roll(uvs, -1, axis=1).ravel()], axis=1)
    back = ways < 0
    ends[back], textures[back] = ends[back][:, ::-1], textures[back][:, ::-1]
    edges = row_ids(np.column_stack([ends, textures, np.repeat(materials, 3)]))
    order = np.argsort(edges, kind="stable")
    same = np.flatnonzero(edges[order][1:] == edges[order][:-1])
    one, other = sides[order[same]] // 3, sides[order[same + 1]] // 3
    return connected_components(one, other, len(faces))[1]


def seconds(call: Callable[[], object]) -> float:
    """Of the processor, the better of two."""
    taken = []
    for _ in range(2):
        started = time.process_time()
        call()
        taken.append(time.process_time() - started)
    return round(min(taken), 5)


def measured(corners: Corners, setting: Setting) -> Record:
    """Bytes and seconds of decoding, by coder."""
    ours = mesh.encode((part_of(corners, setting),))
    theirs = draco.encode_corners(corners, setting)
    optimized = meshopt.encode_corners(corners, setting)
    return {
        "faces": len(corners.faces),
        "setting": dict(setting),
        "bytes": {"ours": len(ours), "draco": len(theirs), "meshoptimizer": len(optimized)},
        "seconds": {
            "ours": seconds(lambda: mesh.decode(ours)),
            "draco": seconds(lambda: DracoPy.decode(theirs)),
            "meshoptimizer": seconds(lambda: meshopt.decode_corners(optimized)),
        },
    }


def meshes(source: Source) -> Iterator[Corners]:
    """The asset at each share of its faces that leaves as many as are wanted."""
    whole = corners_of(source.mesh)
    for share in SHARES:
        wanted = int(share * len(whole.faces))
        if not FACES[0] <= wanted <= FACES[1]:
            continue
        try:
            yield without_slivers(simplified(whole, wanted) if share < 1 else whole)
        except ValueError:
            continue


def summary(rows: list[Record]) -> dict[str, float]:
    """Geometric means of bytes against Draco's, and the worst of ours."""

    def mean(name: str, few: int, most: int) -> float:
        ratios = [
            log(row["bytes"][name] / row["bytes"]["draco"])
            for row in rows
            if few <= row["faces"] < most
        ]
        return round(exp(sum(ratios) / len(ratios)), 4) if ratios else float("nan")

    worst = max(row["bytes"]["ours"] / row["bytes"]["draco"] for row in rows)
    return {
        "ours": mean("ours", 0, 10**6),
        "ours below 1500 faces": mean("ours", 0, 1500),
        "ours from 1500 faces": mean("ours", 1500, 10**6),
        "ours, worst": round(worst, 4),
        "meshoptimizer": mean("meshoptimizer", 0, 10**6),
    }


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("-o", "--output", type=click.Path(path_type=Path))
def main(assets: Path, output: Path | None) -> None:
    """Print bytes for each mesh; write all as JSON."""
    rows = []
    for source in sources(assets):
        for corners in meshes(source):
            for setting in SETTINGS:
                row = {"asset": source.name} | measured(corners, setting)
                rows.append(row)
                click.echo(f"{row['asset']} {row['faces']} {row['setting']} {row['bytes']}")
    means = summary(rows)
    click.echo(means)
    if output is not None:
        record = {"commit": commit(), "machine": machine(), "summary": means, "meshes": rows}
        write_result(output, record)


if __name__ == "__main__":
    main()
