"""`nisp compare`: the distortion of a decode."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .progress import working
from .report import print_group, print_json

if TYPE_CHECKING:
    from nispcodec.core.asset import TexturedMesh
    from nispcodec.metrics.compare import Report


@click.command("compare", short_help="Measure a decode against the original.")
@click.argument("original", type=click.Path(path_type=Path))
@click.argument("decoded", type=click.Path(path_type=Path))
@click.option("--resolution", type=click.IntRange(8, 2048), help="As for decode.")
@click.option("--samples", type=click.IntRange(100), default=100_000, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def command(
    original: Path, decoded: Path, resolution: int | None, samples: int, seed: int, as_json: bool
) -> None:
    """Measure DECODED (a .nisp or a mesh file) against the mesh file ORIGINAL.

    Distances are in the normalized frame of the original. A .nisp is decoded as `nisp decode`
    does, and asked for the charts too.

    \b
    Example: nisp compare model.obj model.nisp
    """
    from nispcodec.io.load import load_mesh

    mesh = load_mesh(original)
    with working(f"comparing {decoded.name} with {original.name}"):
        how = {"samples": samples, "seed": seed}
        if decoded.suffix.lower() == ".nisp":
            report = _compare_model(mesh, decoded, resolution, how)
        else:
            report = _compare_mesh(mesh, decoded, how)
    if as_json:
        print_json(report)
        return
    for title, values in report.items():
        print_group(title, values)


def _compare_mesh(original: TexturedMesh, path: Path, how: dict[str, Any]) -> Report:
    from nispcodec.io.load import load_mesh
    from nispcodec.metrics.compare import compare

    return compare(original, load_mesh(path), **how)


def _compare_model(
    original: TexturedMesh, path: Path, resolution: int | None, how: dict[str, Any]
) -> Report:
    import nispcodec
    from nispcodec.metrics.compare import compare

    model = nispcodec.load(path)
    return compare(original, model.to_mesh(resolution), model=model, **how)
