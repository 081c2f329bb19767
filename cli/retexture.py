"""`nisp retexture`: another image on the same asset."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from .choices import LibraryChoice, slots
from .errors import warn
from .outputs import OutputFile, nisp_suffix, output_option, refuse_overwriting
from .report import print_rate
from .sources import Source, model_argument, parsed, read_file
from .subcommand import force_option, json_option, subcommand


class SlotImage(LibraryChoice):
    """`SLOT=IMAGE`: a slot that the library knows, and the path of an image file."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The slot and the path. Raises BadParameter for another slot or no `=`."""
        slot, equals, image = value.partition("=")
        if not equals:
            self.fail(f"expected SLOT=IMAGE, found {value!r}", param, ctx)
        return super().convert(slot, param, ctx), Path(image)

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """`[base_color|normal]=IMAGE`, for the help."""
        return f"[{'|'.join(self.choices)}]=IMAGE"


@subcommand("retexture", "Replace textures of a .nisp file.")
@model_argument
@click.option(
    "--slot",
    "images",
    type=SlotImage(slots),
    multiple=True,
    required=True,
    help="Such as base_color=edited.png; may be repeated.",
)
@click.option("--material", metavar="NAME", help="Needed when materials have different textures.")
@output_option(OutputFile(nisp_suffix))
@force_option
@json_option
def command(
    model: Source,
    images: tuple[tuple[str, Path], ...],
    material: str | None,
    output: Path,
    force: bool,
    as_json: bool,
) -> None:
    """Put edited images into MODEL (.nisp, or - for standard input); its networks stay.

    Any size, any aspect. `nisp unpack` writes the present images for editing.

    \b
    Example: nisp retexture model.nisp --slot base_color=edited.png -o new.nisp
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.edit.retexture import retextured
    from nispcodec.format import pack

    refuse_overwriting([output], force)
    document = parsed(model.read(), model)
    for slot, image in images:
        data = read_file(image)
        document, warnings = retextured(document, slot, data, str(image), material)
        warn(warnings)
    packed = pack(document)
    write_atomic(output, packed)
    print_rate(output, packed, as_json)
