"""`nisp encode`: a textured mesh to a `.nisp` file."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .files import output_option
from .progress import duration, encode_progress
from .pruning import pruning_options
from .report import print_group, print_json, rate
from .sizes import parsed_size

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.model import NispModel

PRESETS = ("balanced", "paper", "fast", "best")
IMAGE_FORMATS = ("webp", "avif", "jpeg")


@click.command("encode", short_help="Fit networks to a mesh and write a .nisp file.")
@click.argument("mesh", type=click.Path(path_type=Path))
@output_option(".nisp")
@click.option(
    "--preset",
    type=click.Choice(PRESETS),
    default="balanced",
    show_default=True,
    help="20 to 50 s: fast, 1 to 2 min: balanced, 5 to 10 min: best, on two cores.",
)
@click.option(
    "--target-size",
    callback=parsed_size,
    metavar="SIZE",
    help="Of the file without its textures, such as 20kB.",
)
@click.option(
    "--target-error",
    type=float,
    metavar="ERROR",
    help="Mean distance to the surface, such as 5e-4 (of the asset's radius).",
)
@click.option(
    "--seed", type=click.IntRange(0), default=0, show_default=True, help="Of everything random."
)
@click.option("--device", default="auto", show_default=True, help="auto, cpu, cuda.")
@click.option("--threads", type=click.IntRange(0), default=0, help="0, the default: all cores.")
@click.option("--unwrap", is_flag=True, help="Make new UVs with xatlas (drops the textures).")
@click.option(
    "--pad-textures",
    is_flag=True,
    help="Fill what no face uses with the colors beside it: no specks at seams.",
)
@click.option("--texture-format", type=click.Choice(IMAGE_FORMATS), help="Re-encode the images.")
@click.option("--texture-quality", type=click.IntRange(1, 100), default=90, show_default=True)
@pruning_options
@click.option("--no-textures", is_flag=True, help="Leave the images out.")
@click.option("--quiet", is_flag=True, help="No progress.")
@click.option("--json", "as_json", is_flag=True, help="The report as JSON.")
def command(
    mesh: Path,
    output: Path,
    unwrap: bool,
    no_textures: bool,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Fit networks to MESH (.obj, .glb, .gltf, .ply, .stl, .off) and write them.

    \b
    Example: nisp encode model.obj -o model.nisp
             nisp encode model.obj -o model.nisp --preset best --target-size 12kB
             nisp encode model.obj -o model.nisp --prune smallest --prune-rate sdf=0.3,uv=0.5
    """
    import nispcodec

    started = time.monotonic()
    config = nispcodec.EncodeConfig(textures=not no_textures, **how)
    asset = _loaded(mesh, unwrap)
    for warning in asset.warnings:
        click.echo(f"nisp: warning: {warning}", err=True)
    with encode_progress(quiet) as show:
        model = nispcodec.encode(asset, config, progress=show)
    nispcodec.save(model, output)
    report = _report(model, asset, mesh, output, time.monotonic() - started)
    if as_json:
        print_json(report)
    else:
        _print_report(output, report)


def _loaded(path: Path, unwrap: bool) -> TexturedMesh:
    from nispcodec.io.load import load_mesh

    mesh = load_mesh(path)
    if not unwrap:
        return mesh
    from nispcodec.bake.unwrap import unwrap as unwrapped

    return unwrapped(mesh)


def _report(
    model: NispModel, asset: TexturedMesh, source: Path, output: Path, seconds: float
) -> dict[str, Any]:
    beside = () if source.suffix.lower() == ".glb" else asset.textures
    return {
        "bytes": rate(output.read_bytes()),
        "input_bytes": {
            "mesh": source.stat().st_size,
            "textures": sum(len(texture.data) for texture in beside),
        },
        "warnings": list(asset.warnings),
        "measured": dict(model.document.info),
        "seconds": round(seconds, 1),
    }


def _print_report(output: Path, report: dict[str, Any]) -> None:
    parts, source = report["bytes"], report["input_bytes"]
    click.echo(f"{output}: {parts['total']:,} bytes, from {sum(source.values()):,}")
    print_group("bytes", parts, "  ")
    print_group("input_bytes", source, "  ")
    print_group("measured", report["measured"], "  ")
    click.echo(f"  encoded in {duration(report['seconds'])}")
