"""At how many triangles does `.nisp` win? One asset, its surface kept smooth, ever more triangles.

    python -m benchmarks.studies.crossover ../shared/assets/spot/spot.obj

Loop subdivision (Loop 1987) for positions, midpoints for UVs. The file of `.nisp` depends on the
shape, not on the triangles, so it is fitted once, to the second level, and compared with every
level; Draco keeps the triangles; simplify + Draco drops those that the same error does not need.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import igl
import numpy as np

import nispcodec
from benchmarks.assets.corners import corners_of, mesh_of
from benchmarks.assets.simplify import simplified
from benchmarks.assets.source import SEED, Source
from benchmarks.codecs.draco import encode_corners
from benchmarks.codecs.simplified_draco import KEPT
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, write_result
from nispcodec.core.asset import TexturedMesh
from nispcodec.format import pack, unpack
from nispcodec.metrics.compare import Reference
from nispcodec.model import NispModel

FITTED = 1
MOST_FACES = 2_000_000
BITS = {"qp": 11, "qt": 10}
# Counts that a mesh of any size may be simplified to.
TARGETS = [round(6000 * kept) for kept in KEPT] + [9000, 13_000, 20_000]

RESULTS = Path("benchmarks/results/crossover.json")


def subdivided(mesh: TexturedMesh, levels: int) -> TexturedMesh:
    """Four triangles for each, `levels` times."""
    if levels == 0:
        return mesh
    positions, faces = igl.loop(mesh.positions, mesh.faces.astype(np.int64), levels)
    # Both split a face into four in the same order, so that UVs follow their corners.
    uvs, uv_faces = igl.upsample(mesh.uvs, mesh.uv_faces.astype(np.int64), levels)
    return replace(
        mesh,
        positions=np.asarray(positions),
        faces=faces.astype(np.int32),
        uvs=np.asarray(uvs),
        uv_faces=uv_faces.astype(np.int32),
        face_materials=np.repeat(mesh.face_materials, 4**levels),
    )


def level(source: Source, levels: int, nisp: bytes) -> Record:
    """Sizes at one number of triangles; errors are against the mesh with these triangles."""
    mesh = subdivided(source.mesh, levels)
    reference = Reference.of(mesh, seed=SEED)
    corners = corners_of(mesh)
    decoded = NispModel(unpack(nisp)).to_mesh()
    textured = replace(decoded, materials=mesh.materials, textures=mesh.textures)
    ours = errors(reference, textured)
    plain = encode_corners(corners, dict(BITS))
    rival = []
    for target in (count for count in TARGETS if count <= len(mesh.faces)):
        fewer = simplified(corners, target)
        data = encode_corners(fewer, dict(BITS))
        found = errors(reference, mesh_of(source, fewer))
        rival.append({"faces": len(fewer.faces), "bytes": len(data), **found})
    enough = [point["bytes"] for point in rival if point["distance"] <= ours["distance"]]
    return {
        "faces": len(mesh.faces),
        "nisp": {"bytes": len(nisp), **ours},
        "draco": {"bytes": len(plain)},
        "simplified_draco": {"same_distance_bytes": min(enough, default=None), "points": rival},
    }


def errors(reference: Reference, decoded: TexturedMesh) -> dict[str, float]:
    """Mean distance and mean UV error, the larger of both directions."""
    report: Any = reference.compare(decoded)
    return {
        "distance": report["geometry"]["larger"]["mean"],
        "uv": report["uv"]["larger"]["mean"],
    }


@click.command()
@click.argument("asset", type=click.Path(path_type=Path, exists=True))
@click.option("--model", type=click.Path(path_type=Path, exists=True), help="Do not fit: use this.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(asset: Path, model: Path | None, output: Path) -> None:
    """Measure ASSET at its own number of triangles, and at 4, 16, 64 ... times as many."""
    source = Source(asset)
    if model is None:
        fine = subdivided(source.mesh, FITTED)
        config = nispcodec.EncodeConfig(seed=SEED, textures=False)
        nisp = pack(nispcodec.encode(fine, config).document)
    else:
        nisp = model.read_bytes()
    levels: list[Record] = []
    while len(source.mesh.faces) * 4 ** len(levels) <= MOST_FACES:
        levels.append(level(source, len(levels), nisp))
        click.echo(f"{levels[-1]['faces']:>9,} triangles: {told(levels[-1])}", err=True)
    record: Record = {"asset": source.name, "commit": commit(), "machine": machine()}
    record |= {"versions": versions(), "levels": levels}
    write_result(output, record)


def told(found: Record) -> str:
    """One level in words."""
    return (
        f".nisp {found['nisp']['bytes']:,} B at {found['nisp']['distance']:.1e}, Draco "
        f"{found['draco']['bytes']:,} B, simplify + Draco at the same distance "
        f"{found['simplified_draco']['same_distance_bytes']} B"
    )


if __name__ == "__main__":
    main()
