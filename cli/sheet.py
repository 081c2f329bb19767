"""`nisp sheet`: original and decode on one page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import output_option
from .progress import encode_progress
from .report import print_json

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.model import NispModel


@click.command("sheet", short_help="Draw original and decode side by side, with the numbers.")
@click.argument("original", type=click.Path(path_type=Path))
@click.argument("decoded", type=click.Path(path_type=Path))
@output_option(".png", ".webp")
@click.option("--size", type=click.IntRange(32, 2048), default=320, show_default=True)
@click.option("--json", "as_json", is_flag=True, help="The numbers, as JSON.")
def command(original: Path, decoded: Path, output: Path, size: int, as_json: bool) -> None:
    """Draw DECODED (a .nisp or a mesh file) beside the mesh file ORIGINAL on one page.

    Four views, close-ups of the largest differences, UV layouts, and the numbers of `nisp compare`.
    --size is that of each picture in pixels.

    \b
    Example: nisp sheet model.obj model.nisp -o sheet.png
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.io.load import load_mesh
    from nispcodec.render.images import image_bytes
    from nispcodec.render.sheet import sheet

    mesh, other = load_mesh(original), _decoded(decoded)
    title = f"{original.name}, {len(mesh.faces):,} faces: {decoded.name}, {_size(decoded)}"
    with encode_progress(quiet=False) as listener:
        page = sheet(mesh, other, size, title, listener)
    write_atomic(output, image_bytes([page.picture], output.suffix.lower()))
    if as_json:
        print_json(page.report)
    else:
        click.echo(str(output))


def _decoded(path: Path) -> NispModel | TexturedMesh:
    import nispcodec
    from nispcodec.io.load import load_mesh

    return nispcodec.load(path) if path.suffix.lower() == ".nisp" else load_mesh(path)


def _size(path: Path) -> str:
    """The bytes of a file; of a `.nisp` without its textures too."""
    from .report import rate

    data = path.read_bytes()
    if path.suffix.lower() != ".nisp":
        return f"{len(data) / 1e3:,.1f} kB"
    part = rate(data)
    return f"{part['geometry_uv'] / 1e3:,.1f} kB and textures of {part['textures'] / 1e3:,.1f} kB"
