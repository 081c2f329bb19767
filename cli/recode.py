"""`nisp recode`: the same networks in another file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import output_option
from .report import print_group, rate

if TYPE_CHECKING:
    from nispcodec.core.document import Document

CODINGS = ("dense", "coo", "csc", "csr", "dia", "entropy", "delta_init")
IMAGE_FORMATS = ("webp", "avif", "jpeg")


@click.command("recode", short_help="Rewrite a .nisp file with other codings or images.")
@click.argument("model", type=click.Path(path_type=Path))
@output_option(".nisp")
@click.option(
    "--coding", type=click.Choice(CODINGS), help="Of all weights; by default the smallest for each."
)
@click.option("--texture-format", type=click.Choice(IMAGE_FORMATS), help="Re-encode the images.")
@click.option("--texture-quality", type=click.IntRange(1, 100), default=90, show_default=True)
@click.option("--no-textures", is_flag=True, help="Leave the images out.")
def command(
    model: Path,
    output: Path,
    coding: str | None,
    texture_format: str | None,
    texture_quality: int,
    no_textures: bool,
) -> None:
    """Rewrite MODEL without touching what its networks compute.

    \b
    Example: nisp recode model.nisp -o small.nisp --texture-format webp
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.format import pack, read

    document = read(model)
    if no_textures:
        document = _without_textures(document)
    elif texture_format is not None:
        document = _with_textures(document, texture_format, texture_quality)
    data = pack(document, coding)
    write_atomic(output, data)
    print_group(str(output), rate(data))


def _without_textures(document: Document) -> Document:
    bare = tuple(replace(material, maps={}) for material in document.materials)
    return replace(document, materials=bare, textures=())


def _with_textures(document: Document, kind: str, quality: int) -> Document:
    from nispcodec.core.texture import reencode

    images = reencode(document.textures, kind, quality)
    return replace(document, textures=images)
