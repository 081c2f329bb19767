"""`nisp unpack`: the textures of a `.nisp` file as image files."""

from __future__ import annotations

from pathlib import Path

import click


@click.command("unpack", short_help="Write the textures of a .nisp file.")
@click.argument("model", type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="A folder.")
def command(model: Path, output: Path) -> None:
    """Write MODEL's images, byte for byte, into a folder: to look at, or to edit.

    `nisp retexture` puts them back.

    \b
    Example: nisp unpack model.nisp -o textures
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.format import read

    textures = read(model).textures
    output.mkdir(parents=True, exist_ok=True)
    for texture in textures:
        path = output / texture.name  # a bare file name: the format allows no other
        write_atomic(path, texture.data)
        click.echo(str(path))
    if not textures:
        click.echo(f"nisp: warning: {model} holds no textures", err=True)
