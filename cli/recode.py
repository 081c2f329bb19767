"""`nisp recode`: the same networks and images, stored in another way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .choices import LibraryChoice, codings, image_formats
from .outputs import OutputFile, nisp_suffix, output_option, refuse_overwriting
from .ranges import Whole
from .report import print_rate
from .sources import Source, model_argument, parsed
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.document import Document


@subcommand("recode", "Rewrite a .nisp file with other codings or images.")
@model_argument
@output_option(OutputFile(nisp_suffix))
@click.option(
    "--coding",
    type=LibraryChoice(codings),
    help="Of all weights; by default the smallest for each.",
)
@click.option(
    "--texture-format",
    type=LibraryChoice(image_formats),
    help="Re-encode the images. Normal maps and other data keep all channels as sharp: webp is "
    "lossless for them.",
)
@click.option("--texture-quality", type=Whole(1, 100), default=90, show_default=True)
@click.option("--no-textures", is_flag=True, help="Leave the images out.")
@force_option
@json_option
def command(
    model: Source,
    output: Path,
    coding: str | None,
    texture_format: str | None,
    texture_quality: int,
    no_textures: bool,
    force: bool,
    as_json: bool,
) -> None:
    """Rewrite MODEL (.nisp, or - for standard input): its networks compute the same.

    \b
    Example: nisp recode model.nisp -o small.nisp --texture-format webp
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.format import pack

    refuse_overwriting([output], force)
    document = parsed(model.read(), model)
    if no_textures:
        document = _without_textures(document)
    elif texture_format is not None:
        document = _with_textures(document, texture_format, texture_quality)
    data = pack(document, coding)
    write_atomic(output, data)
    print_rate(output, data, as_json)


def _without_textures(document: Document) -> Document:
    bare = tuple(replace(material, maps={}) for material in document.materials)
    return replace(document, materials=bare, textures=())


def _with_textures(document: Document, kind: str, quality: int) -> Document:
    from nispcodec.core.texture import data_maps, reencode

    images = reencode(document.textures, kind, quality, data_maps(document.materials))
    return replace(document, textures=images)
