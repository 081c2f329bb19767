"""What creases cost in bytes, and how near they bring the shading of triangles to the original's.

    python -m benchmarks.studies.shading --assets ../shared/assets --asset kaykit_knight

Each asset as triangles, all of its faces and half of them: bytes with and without creases; PSNR of
pictures, in one gray material, against the original drawn with the creases of its file. Decoded
with the creases that were written, with those that readers find where none are, and all smooth.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np

from benchmarks.assets.source import Source, sources
from benchmarks.measuring.machine import commit
from benchmarks.measuring.result_file import write_result
from benchmarks.studies.mesh_parts import simplifier_of, size
from nispcodec.core.arrays import Float32Array
from nispcodec.core.asset import Material, TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.mesh_part import MeshPart
from nispcodec.extract.mesh_parts import joined
from nispcodec.geometry.analysis import normalizing_frame
from nispcodec.metrics.psnr import psnr
from nispcodec.render.camera import turntable
from nispcodec.render.views import render_views

GRAY = Material(base_color=(0.7, 0.7, 0.7, 1.0), roughness=0.5)
VIEWS, PIXELS = 4, 256
DISTANCE, UV = 5e-5, 1e-3
"""Errors whose rounding the grids suit."""
SHARES = (1.0, 0.5)
RESULTS = Path("benchmarks/results/shading.json")


def measured(source: Source) -> Iterator[dict[str, Any]]:
    """A row for every share of the faces."""
    wanted = pictures(source.mesh, source)
    ours = simplifier_of(source)
    bits, uv_bits = ours.bits_for(DISTANCE), ours.uv_bits_for(UV)
    for share in SHARES:
        parts = ours.candidate(round(share * len(ours.source.triangles)), bits, uv_bits).parts
        bare = tuple(replace(part, creases=np.zeros_like(part.creases)) for part in parts)
        written = decoded(parts, source)
        smooth = np.zeros(written.faces.shape, np.bool_)
        ways = {
            "written": written,
            "found": decoded(bare, source),
            "smooth": replace(written, creases=smooth),
        }
        yield {
            "faces": sum(len(part.faces) for part in parts),
            "bytes": size(parts),
            "bytes_of_creases": size(parts) - size(bare),
            **{name: against(wanted, pictures(mesh, source)) for name, mesh in ways.items()},
        }


def decoded(parts: tuple[MeshPart, ...], source: Source) -> TexturedMesh:
    """What a file with these parts decodes to."""
    frame = normalizing_frame(source.mesh)
    return joined(Document(frame, source.mesh.materials, source.mesh.textures, meshes=parts), None)


def pictures(mesh: TexturedMesh, source: Source) -> list[Float32Array]:
    """The mesh in gray, placed as the source is."""
    gray = replace(mesh, materials=(GRAY,) * len(mesh.materials), textures=())
    frame = normalizing_frame(source.mesh)
    return render_views(gray, turntable(VIEWS), PIXELS, frame)


def against(wanted: list[Float32Array], found: list[Float32Array]) -> float:
    """PSNR of the pixels that both show, dB."""
    one, other = np.stack(wanted), np.stack(found)
    off = (one - other)[(one[..., 3] > 0.5) & (other[..., 3] > 0.5), :3]
    return round(psnr(float((off**2).mean()), 1.0), 2)


@click.command()
@click.option("--assets", type=click.Path(path_type=Path, exists=True), required=True)
@click.option("--asset", "names", multiple=True, help="Only these.")
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
def main(assets: Path, names: tuple[str, ...], output: Path) -> None:
    """Print a line for every mesh and write all as JSON."""
    table: dict[str, list[dict[str, Any]]] = {}
    for source in sources(assets):
        if not names or source.name in names:
            table[source.name] = []
            for row in measured(source):
                table[source.name].append(row)
                click.echo(f"{source.name:<24}{row}")
            write_result(output, {"commit": commit(), "assets": table})


if __name__ == "__main__":
    main()
