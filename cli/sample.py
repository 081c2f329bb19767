"""`nisp sample`: an asset to play with, made on the spot."""

from __future__ import annotations

from pathlib import Path

from .outputs import folder_option, listed, make_folder, refuse_overwriting
from .report import print_json, print_written
from .subcommand import force_option, json_option, subcommand

NAME = "sample.obj"


@subcommand("sample", "Write a sample asset to play with.")
@folder_option
@force_option
@json_option
def command(output: Path, force: bool, as_json: bool) -> None:
    """Write a procedural textured OBJ with several charts and materials into a folder.

    \b
    Example: nisp sample -o demo
    """
    from nispcodec.io.save import mesh_paths, write_mesh
    from nispcodec.procedural.mug import sample_asset

    asset, path = sample_asset(), output / NAME
    refuse_overwriting(mesh_paths(path, asset.materials, asset.textures), force)
    make_folder(output)
    written = write_mesh(asset, path)
    if as_json:
        print_json({"file": str(path), "files": listed(written)})
    else:
        print_written(written)
