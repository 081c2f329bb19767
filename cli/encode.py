"""`nisp encode`: a textured mesh to a `.nisp` file."""

from __future__ import annotations

import shutil
import time
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .choices import LibraryChoice, engines, geometries, presets, texture_formats
from .errors import warn
from .lines import duration
from .outputs import OutputFile, nisp_suffix, output_option, refuse_overwriting_others
from .parts import in_a_line, parts_of, why, with_errors
from .progress import progress_options, shown
from .pruning import pruning_options
from .ranges import Real, Whole
from .report import print_group, print_json, rate
from .sizes import parsed_size
from .sources import read_counted
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from collections.abc import Mapping

    from nispcodec.catalogue.inputs import InputBytes
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.core.progress import Listener, Progress
    from nispcodec.encode.config import EncodeConfig
    from nispcodec.model import NispModel

LARGEST_NETWORKS = 1_000_000
"""Bytes of a file besides its textures: more than any preset writes."""
MOST_OF_A_FILE = 0.8
"""Share of a file from which on its textures are worth a hint."""


@subcommand("encode", "Write a mesh as a .nisp file.")
@click.argument("mesh", type=click.Path(path_type=Path))
@output_option(OutputFile(nisp_suffix))
@click.option(
    "--preset",
    type=LibraryChoice(presets),
    default="balanced",
    show_default=True,
    help="How long to learn: fast, balanced or best; paper is the published method.",
)
@click.option(
    "--geometry",
    type=LibraryChoice(geometries),
    default="auto",
    show_default=True,
    help="As a field (networks) or as a mesh (triangles); auto takes what is smaller, or both.",
)
@click.option(
    "--target-size",
    callback=parsed_size,
    metavar="SIZE",
    help="Of the file without its textures, at most, such as 20kB.",
)
@click.option(
    "--target-total",
    callback=parsed_size,
    metavar="SIZE",
    help="Of the whole file, such as 100kB: images are coded again, as auto does, to the quality "
    "that fits.",
)
@click.option(
    "--target-error",
    type=Real(0, min_open=True),
    metavar="ERROR",
    help="Mean distance to the surface, such as 5e-4 (of the asset's radius).",
)
@click.option("--seed", type=Whole(0), default=0, show_default=True, help="Of everything random.")
@click.option(
    "--engine",
    type=LibraryChoice(engines),
    default="auto",
    show_default=True,
    help="What trains: native is many times as fast as torch, which has CUDA.",
)
@click.option(
    "--device", default="auto", show_default=True, help="auto, cpu, cuda or cuda:N.", metavar="NAME"
)
@click.option("--threads", type=Whole(0), default=0, help="0, the default: all cores.")
@click.option("--unwrap", is_flag=True, help="Make new UVs with xatlas (drops the textures).")
@click.option(
    "--pad-textures",
    is_flag=True,
    help="Fill what no face uses with the colors beside it: no specks at seams.",
)
@click.option(
    "--texture-format",
    type=LibraryChoice(texture_formats),
    help="Re-encode the images; auto pads them and takes AVIF. Normal maps and other data keep all "
    "channels as sharp: webp is lossless for them.",
)
@click.option("--texture-quality", type=Whole(1, 100), default=90, show_default=True)
@pruning_options
@click.option("--no-textures", is_flag=True, help="Leave the images out.")
@force_option
@progress_options
@json_option
def command(
    mesh: Path,
    output: Path,
    unwrap: bool,
    no_textures: bool,
    force: bool,
    progress: str,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Write MESH (.obj .gltf .glb .ply .stl .off) as networks or triangles, what is smaller.

    An earlier output of the same name is replaced; any other file only with --force.

    \b
    Example: nisp encode model.obj -o model.nisp
             nisp encode model.obj -o model.nisp --preset best --target-size 12kB
             nisp encode model.obj -o model.nisp --target-total 100kB
             nisp encode model.obj -o model.nisp --prune smallest --prune-rate sdf=0.3,uv=0.5
    """
    import nispcodec

    started = time.monotonic()
    refuse_overwriting_others(output, force)
    config = nispcodec.EncodeConfig(textures=not no_textures, **how)
    asset, read = _loaded(mesh, unwrap)
    warn(asset.warnings)
    _expect_possible(asset, config, output)
    heard = _Heard()
    model = _encoded(asset, config, progress, quiet, heard)
    asset = replace(asset, warnings=(*asset.warnings, *heard.warnings))
    nispcodec.save(model, output)
    report = _report(model, asset, config, read, output, time.monotonic() - started)
    report["parts"] = with_errors(report["parts"], heard.part_errors)
    if as_json:
        print_json(report)
    else:
        _print_report(report)


@dataclass
class _Heard:
    """The warnings and errors that an encode tells by the way, for its report."""

    warnings: list[str] = field(default_factory=list)
    part_errors: tuple[tuple[float, float], ...] = ()

    def beside(self, listen: Listener) -> Listener:
        """The listener, with what is warned of as a note, and kept to be said again.

        A note may go by, or not be shown at all, but a warning is read by who looks at the end.
        """

        def heard(update: Progress) -> None:
            if update.warning:
                self.warnings.append(update.warning)
            self.part_errors = update.part_errors or self.part_errors
            listen(replace(update, note=update.note or update.warning))

        return heard


def _encoded(
    asset: TexturedMesh, config: EncodeConfig, progress: str, quiet: bool, heard: _Heard
) -> NispModel:
    """The model; what was warned of is said at the end whatever happens."""
    import nispcodec

    try:
        with shown("encode", progress, quiet) as listen:
            return nispcodec.encode(asset, config, progress=heard.beside(listen))
    finally:
        warn(heard.warnings)


def _loaded(path: Path, unwrap: bool) -> tuple[TexturedMesh, InputBytes]:
    mesh, read = read_counted(path)
    if not unwrap:
        return mesh, read
    from .unwrapping import unwrapped

    return unwrapped(mesh), read


def _expect_possible(asset: TexturedMesh, config: EncodeConfig, output: Path) -> None:
    """Raises NispError, before the work, for what would fail after it."""
    from nispcodec.core.errors import NispError
    from nispcodec.format.constants import MAX_ITEMS
    from nispcodec.format.materials import encode_material, encode_textures

    textures = asset.textures if config.textures else ()
    for what, found in (("materials", asset.materials), ("textures", textures)):
        if len(found) > MAX_ITEMS:
            raise NispError(f"{what}: expected at most {MAX_ITEMS}, found {len(found)}")
    for material in asset.materials:
        encode_material(material)
    encode_textures(textures)
    needed = LARGEST_NETWORKS + sum(len(texture.data) for texture in textures)
    free = shutil.disk_usage(output.parent).free
    if free < needed:
        raise NispError(f"{output}: expected {needed:,} bytes free on the disk, found {free:,}")


def _report(
    model: NispModel,
    asset: TexturedMesh,
    config: EncodeConfig,
    read: InputBytes,
    output: Path,
    seconds: float,
) -> dict[str, Any]:
    return {
        "file": str(output),
        "bytes": rate(output.read_bytes()),
        "input_bytes": asdict(read),
        "held_as": why(model.document),
        "parts": parts_of(model.document, output.read_bytes()),
        "hint": _hint(rate(output.read_bytes()), config),
        "warnings": list(asset.warnings),
        "measured": dict(model.document.info),
        "seconds": round(seconds, 1),
    }


def _hint(parts: Mapping[str, int], config: EncodeConfig) -> str:
    """What to do about textures that are most of the file; empty where they are not."""
    share = parts["textures"] / parts["total"]
    if share <= MOST_OF_A_FILE or config.target_total or config.texture_format:
        return ""
    return (
        f"textures are {share:.0%} of the file: --texture-format auto codes them as AVIF, "
        "--target-total SIZE to a size"
    )


def _print_report(report: dict[str, Any]) -> None:
    parts, source = report["bytes"], report["input_bytes"]
    click.echo(f"{report['file']}: {parts['total']:,} bytes, from {sum(source.values()):,}")
    click.echo(f"  held as {report['held_as']}")
    if len(report["parts"]) > 1:
        for part in report["parts"]:
            click.echo(f"    {in_a_line(part)}")
    print_group("bytes", parts, "  ")
    print_group("input_bytes", source, "  ")
    print_group("measured", report["measured"], "  ")
    if report["hint"]:
        click.echo(f"  {report['hint']}")
    click.echo(f"  encoded in {duration(report['seconds'])}")
