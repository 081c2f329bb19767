"""`nisp decode`: a `.nisp` file to a textured mesh."""

from __future__ import annotations

from pathlib import Path

import click

from .files import output_option
from .progress import working

SUFFIXES = (".glb", ".obj", ".ply", ".stl")


@click.command("decode", short_help="Write a .nisp file as a textured mesh.")
@click.argument("model", type=click.Path(path_type=Path))
@output_option(*SUFFIXES)
@click.option(
    "--mesh", "kind", flag_value="mesh", default="mesh", help="A textured mesh (default)."
)
@click.option("--resolution", type=click.IntRange(8, 2048), help="Cells a side; 256 or as needed.")
def command(model: Path, output: Path, kind: str, resolution: int | None) -> None:
    """Write the surface of MODEL (.nisp) as a textured mesh, in the units of the original.

    An OBJ gets its MTL and images beside it.

    \b
    Example: nisp decode model.nisp --mesh -o out.glb
    """
    import nispcodec
    from nispcodec.decode.writers import write_mesh

    loaded = nispcodec.load(model)
    with working(f"decoding {model.name}"):
        mesh = loaded.to_mesh(resolution)
        written = write_mesh(mesh, output)
    click.echo(f"{output}: {len(mesh.faces):,} faces, {len(written)} file(s)")
