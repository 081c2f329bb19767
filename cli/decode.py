"""`nisp decode`: a `.nisp` file to a textured mesh."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import output_option
from .progress import working

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.model import NispModel

SUFFIXES = (".glb", ".obj", ".ply", ".stl")
REBAKE_FACES = 20_000
"""Making an atlas takes minutes for the hundreds of thousands of triangles of a plain decode."""


@click.command("decode", short_help="Write a .nisp file as a textured mesh.")
@click.argument("model", type=click.Path(path_type=Path))
@output_option(*SUFFIXES)
@click.option(
    "--mesh", "kind", flag_value="mesh", default="mesh", help="A textured mesh (default)."
)
@click.option(
    "--resolution", type=click.IntRange(8, 2048), help="Cells a side; 256 to 512 unless told."
)
@click.option("--faces", type=click.IntRange(4), help="Simplify to at most this many triangles.")
@click.option(
    "--target-error",
    type=click.FloatRange(0, min_open=True),
    help="As few triangles as keep the mean distance to the field's surface below this, in radii.",
)
@click.option("--colors", is_flag=True, help="Vertex colors instead of textures.")
@click.option(
    "--rebake",
    type=click.IntRange(16, 8192),
    is_flag=False,
    flag_value=1024,
    metavar="[SIZE]",
    help=f"One new atlas, textures 1024 texels wide; {REBAKE_FACES:,} faces unless told.",
)
@click.option("--keep-spurious", is_flag=True, help="Keep what is recognized as noise.")
def command(
    model: Path,
    output: Path,
    kind: str,
    resolution: int | None,
    faces: int | None,
    target_error: float | None,
    colors: bool,
    rebake: int | None,
    keep_spurious: bool,
) -> None:
    """Write the surface of MODEL (.nisp) as a textured mesh, in the units of the original.

    An OBJ gets its MTL and images beside it.

    \b
    Example: nisp decode model.nisp --mesh -o out.glb
    """
    import nispcodec
    from nispcodec.io.save import write_mesh

    if colors and rebake:
        raise click.UsageError("--colors and --rebake: expected one of them, found both")
    if rebake and faces is None and target_error is None:
        faces = REBAKE_FACES
    loaded = nispcodec.load(model)
    with working(f"decoding {model.name}"):
        mesh = loaded.to_mesh(resolution, faces, target_error, keep_spurious)
        if rebake:
            mesh = baked(loaded, mesh, rebake)
        written = write_mesh(mesh, output, loaded.color(mesh.positions) if colors else None)
    for warning in mesh.warnings:
        click.echo(f"nisp: warning: {warning}", err=True)
    click.echo(f"{output}: {len(mesh.faces):,} faces, {len(written)} file(s)")


def baked(model: NispModel, mesh: TexturedMesh, size: int) -> TexturedMesh:
    """The mesh with an atlas and textures of its own."""
    from nispcodec.bake.rebake import rebaked
    from nispcodec.bake.unwrap import unwrap

    return replace(rebaked(model, unwrap(mesh), size), warnings=mesh.warnings)
