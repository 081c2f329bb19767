"""`nisp sample`: an asset to play with, made on the spot."""

from __future__ import annotations

from pathlib import Path

import click

NAME = "sample.obj"


@click.command("sample", short_help="Write a sample asset to play with.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="A folder.")
def command(output: Path) -> None:
    """Write a procedural textured OBJ with several charts and materials into a folder.

    \b
    Example: nisp sample -o demo
    """
    from nispcodec.io.save import write_mesh
    from nispcodec.procedural.mug import sample_asset

    output.mkdir(parents=True, exist_ok=True)
    for path in write_mesh(sample_asset(), output / NAME):
        click.echo(str(path))
