"""`nisp unpack`: the textures of a `.nisp` file as image files."""

from __future__ import annotations

from pathlib import Path

from .errors import warn
from .outputs import folder_option, listed, make_folder, refuse_overwriting
from .report import print_json, print_written
from .sources import Source, model_argument, parsed
from .subcommand import force_option, json_option, subcommand


@subcommand("unpack", "Write the textures of a .nisp file.")
@model_argument
@folder_option
@force_option
@json_option
def command(model: Source, output: Path, force: bool, as_json: bool) -> None:
    """Write the images of MODEL (.nisp, or - for standard input), byte for byte, into a folder.

    To look at, or to edit: `nisp retexture` puts them back. A name that comes twice gets a number.

    \b
    Example: nisp unpack model.nisp -o textures
    """
    from nispcodec.core.atomic_write import write_atomic
    from nispcodec.core.texture import distinct_names

    textures = parsed(model.read(), model).textures
    # Bare names: no other is allowed. They need not differ.
    paths = [output / name for name in distinct_names([texture.name for texture in textures])]
    refuse_overwriting(paths, force)
    make_folder(output)
    for path, texture in zip(paths, textures, strict=True):
        write_atomic(path, texture.data)
    if not textures:
        warn([f"{model} holds no textures"])
    if as_json:
        print_json({"files": listed(paths)})
    else:
        print_written(paths)
