"""`nisp sheet`: original and decode on one page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .choices import exact_picture_suffixes
from .outputs import OutputFile, output_option, refuse_overwriting
from .progress import progress_options, shown
from .ranges import Whole
from .report import print_json, print_written, rate
from .sources import is_nisp, parsed, read_file, read_mesh
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.model import NispModel


@subcommand("sheet", "Draw original and decode side by side, with the numbers.")
@click.argument("original", type=click.Path(path_type=Path))
@click.argument("decoded", type=click.Path(path_type=Path))
@output_option(OutputFile(exact_picture_suffixes))
@click.option("--size", type=Whole(32, 2048), default=320, show_default=True)
@force_option
@progress_options
@json_option
def command(
    original: Path,
    decoded: Path,
    output: Path,
    size: int,
    force: bool,
    progress: str,
    quiet: bool,
    as_json: bool,
) -> None:
    """Draw DECODED (a .nisp or a mesh file) beside the mesh file ORIGINAL on one page.

    Four views, close-ups of the largest differences, UV layouts, and the numbers of `nisp compare`.
    --size is that of each picture in pixels.

    \b
    Example: nisp sheet model.obj model.nisp -o sheet.png
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.core.counted import counted
    from nispcodec.render.images import image_bytes
    from nispcodec.render.sheet import sheet

    refuse_overwriting([output], force)
    mesh, (other, kilobytes) = read_mesh(original), _decoded(decoded)
    title = f"{original.name}, {counted(len(mesh.faces), 'face')}: {decoded.name}, {kilobytes}"
    with shown("sheet", progress, quiet) as listen:
        page = sheet(mesh, other, size, title, listen)
    write_atomic(output, image_bytes([page.picture], output.suffix.lower()))
    if as_json:
        print_json({"file": str(output), **page.report})
    else:
        print_written([output])


def _decoded(path: Path) -> tuple[NispModel | TexturedMesh, str]:
    """A model or a mesh, and how large its file is: a `.nisp` without its textures too."""
    from nispcodec.model import NispModel

    if not is_nisp(path):
        return read_mesh(path), f"{path.stat().st_size / 1e3:,.1f} kB"
    data = read_file(path)
    model, part = NispModel(parsed(data, path)), rate(data)
    geometry, textures = part["geometry_uv"] / 1e3, part["textures"] / 1e3
    return model, f"{geometry:,.1f} kB and textures of {textures:,.1f} kB"
