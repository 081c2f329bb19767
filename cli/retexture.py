"""`nisp retexture`: another image on the same asset."""

from __future__ import annotations

from pathlib import Path

import click

from .files import output_option
from .report import print_group, rate


@click.command("retexture", short_help="Replace textures of a .nisp file.")
@click.argument("model", type=click.Path(path_type=Path))
@click.option(
    "--slot",
    "slots",
    multiple=True,
    required=True,
    metavar="SLOT=IMAGE",
    help="Such as base_color=edited.png; may be repeated.",
)
@click.option("--material", metavar="NAME", help="Needed when materials have different textures.")
@output_option(".nisp")
def command(model: Path, slots: tuple[str, ...], material: str | None, output: Path) -> None:
    """Put edited images into MODEL; its networks are not touched. Any size, any aspect.

    `nisp unpack` writes the present images for editing.

    \b
    Example: nisp retexture model.nisp --slot base_color=edited.png -o new.nisp
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.edit.retexture import retextured
    from nispcodec.format import pack, read

    document = read(model)
    for text in slots:
        slot, equals, image = text.partition("=")
        if not equals:
            raise click.UsageError(f"--slot: expected SLOT=IMAGE, found {text!r}")
        data = Path(image).read_bytes()
        document, warnings = retextured(document, slot, data, image, material)
        for warning in warnings:
            click.echo(f"nisp: warning: {warning}", err=True)
    packed = pack(document)
    write_atomic(output, packed)
    print_group(str(output), rate(packed))
