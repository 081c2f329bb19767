"""`nisp sample`: an asset to play with, or a catalogue of them, made on the spot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .outputs import folder_option, listed, make_folder, refuse_overwriting
from .ranges import Whole
from .report import print_json, print_written
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.procedural.variety import Sample

NAME = "sample.obj"


@subcommand("sample", "Write a sample asset, or many, to play with.")
@folder_option
@click.option("--count", type=Whole(1, 1_000_000), help="So many assets of many kinds.")
@click.option("--seed", type=Whole(0), default=0, show_default=True, help="Of their variety.")
@force_option
@json_option
def command(output: Path, count: int | None, seed: int, force: bool, as_json: bool) -> None:
    """Write a procedural textured OBJ with several charts and materials into a folder.

    With --count, a catalogue for nisp batch in its place: OBJ, GLB and PLY in several folders, one
    in twenty broken on purpose, as its name says.

    \b
    Example: nisp sample -o demo
             nisp sample --count 200 --seed 7 -o catalogue
    """
    told: dict[str, Any] = {}
    if count is None:
        path, written = _single(output, force)
        told["file"] = str(path)
    else:
        written = _many(output, count, seed, force)
        told["assets"] = count
    if as_json:
        print_json({**told, "files": listed(written)})
    elif count is None:
        print_written(written)
    else:
        click.echo(f"{output}: {count:,} assets, {len(written):,} files")


def _single(output: Path, force: bool) -> tuple[Path, list[Path]]:
    """Write the one asset -> its file, and all files."""
    from nispcodec.io.save import mesh_paths, write_mesh
    from nispcodec.procedural.mug import sample_asset

    asset, path = sample_asset(), output / NAME
    refuse_overwriting(mesh_paths(path, asset.materials, asset.textures), force)
    make_folder(output)
    return path, write_mesh(asset, path)


def _many(output: Path, count: int, seed: int, force: bool) -> list[Path]:
    """Write a catalogue -> all its files."""
    from nispcodec.procedural.variety import catalogue

    written: list[Path] = []
    for sample in catalogue(count, seed):
        written += _written(sample, output, force)
    return written


def _written(sample: Sample, output: Path, force: bool) -> list[Path]:
    from nispcodec.io.save import mesh_paths, write_mesh
    from nispcodec.procedural.variety import damaged

    mesh, path = sample.mesh, output / f"{sample.way}{sample.suffix}"
    refuse_overwriting(mesh_paths(path, mesh.materials, mesh.textures), force)
    make_folder(path.parent)
    files = write_mesh(mesh, path)
    if sample.broken == "no-image":
        for each in files:
            if each.suffix == ".png":
                each.unlink()
    elif sample.broken:
        path.write_bytes(damaged(path.read_bytes(), sample.broken))
    return [each for each in files if each.exists()]
