"""`nisp compare`: the distortion of a decode."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .columns import FRAME, explanations
from .errors import warn
from .progress import progress_options, shown
from .ranges import Whole
from .report import print_group, print_json
from .sources import is_nisp, parsed, read_file, read_mesh
from .subcommand import json_option, subcommand
from .verdict import bounds, verdict

if TYPE_CHECKING:
    from collections.abc import Iterator

    from nispcodec.core.asset import TexturedMesh
    from nispcodec.core.progress import Listener
    from nispcodec.metrics.compare import Report
    from nispcodec.model import NispModel

MOST_APART = 2.0
"""Ratio of radii from which on they are told of: no codec is that far off."""


@subcommand("compare", "Measure a decode against the original.")
@click.argument("original", type=click.Path(path_type=Path))
@click.argument("decoded", type=click.Path(path_type=Path))
@click.option("--resolution", type=Whole(8, 2048), help="As for decode.")
@click.option("--samples", type=Whole(100), default=100_000, show_default=True)
@click.option("--seed", type=Whole(0), default=0, show_default=True, help="Of the samples.")
@click.option("--explain", is_flag=True, help="Say what each number means.")
@progress_options
@json_option
def command(
    original: Path,
    decoded: Path,
    resolution: int | None,
    explain: bool,
    progress: str,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Measure DECODED (a .nisp or a mesh file) against the mesh file ORIGINAL.

    Distances are in the normalized frame of the original: shares of its radius. A .nisp is decoded
    as `nisp decode` does, and asked for the charts too. The last line is a verdict in words.

    \b
    Example: nisp compare model.obj model.nisp --explain
    """
    mesh, other = read_mesh(original), _read(decoded)
    warn(_other_unit(mesh, other, decoded))
    with shown("compare", progress, quiet) as listen:
        report = _compared(mesh, other, resolution, listen, how)
    if as_json:
        told = {"explained": explanations(report)} if explain else {}
        print_json({**report, "verdict": verdict(report), **told})
        return
    for title, values in report.items():
        print_group(title, values)
    if explain:
        _explain(report)
    click.echo(verdict(report))


def _read(path: Path) -> TexturedMesh | NispModel:
    from nispcodec.model import NispModel

    return NispModel(parsed(read_file(path), path)) if is_nisp(path) else read_mesh(path)


def _other_unit(
    original: TexturedMesh, decoded: TexturedMesh | NispModel, path: Path
) -> Iterator[str]:
    """A warning where one is several times as large as the other."""
    from nispcodec.metrics.surface import frame_of
    from nispcodec.model import NispModel

    frame = decoded.document.frame if isinstance(decoded, NispModel) else frame_of(decoded)
    ratio = frame.radius / frame_of(original).radius
    if max(ratio, 1 / ratio) > MOST_APART:
        yield f"{path}: {ratio:.4g} times as large as the original: is it in the same unit?"


def _compared(
    original: TexturedMesh,
    decoded: TexturedMesh | NispModel,
    resolution: int | None,
    listen: Listener,
    how: dict[str, Any],
) -> Report:
    from nispcodec.core.progress import Progress
    from nispcodec.metrics.compare import compare
    from nispcodec.model import NispModel

    if not isinstance(decoded, NispModel):
        listen(Progress(stage="distances, UVs, colors", overall=0.0))
        return compare(original, decoded, **how)
    listen(Progress(stage="surface", overall=0.0))
    mesh = decoded.to_mesh(resolution)
    listen(Progress(stage="distances, UVs, colors, charts", overall=0.4))
    return compare(original, mesh, model=decoded, **how)


def _explain(report: Report) -> None:
    click.echo()
    for title, lines in explanations(report).items():
        print_group(title, lines)
    click.echo(f"{FRAME}\n{bounds()}\n")
