"""`nisp decode --grid`: signed distances on a grid, for simulators and other programs."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .errors import warn
from .lines import duration
from .outputs import listed, refuse_overwriting
from .report import print_json, print_written

if TYPE_CHECKING:
    from nispcodec.core.progress import Listener
    from nispcodec.model import NispModel

SUFFIX = ".npz"
FITS = {"model", "output", "grid", "resolution", "force", "progress", "quiet", "as_json"}
"""The parameters of `nisp decode` that a grid has a use for."""


def expect_fitting(output: Path, samples: int | None) -> None:
    """Raises UsageError for a grid in a file of meshes, the other way round, or other options."""
    if (output.suffix.lower() == SUFFIX) != (samples is not None):
        raise click.UsageError(f"--grid: expected with a {SUFFIX}, and only there, found {output}")
    context = click.get_current_context()
    given = [each for each in context.command.params if _is_given(context, each)]
    others = [each.opts[0] for each in given if each.name not in FITS]
    if samples is not None and others:
        raise click.UsageError(f"--grid and {others[0]}: expected one of them, found both")


def _is_given(context: click.Context, parameter: click.Parameter) -> bool:
    source = context.get_parameter_source(parameter.name or "")
    return source is click.core.ParameterSource.COMMANDLINE


def write_grid(
    model: NispModel,
    output: Path,
    samples: int,
    resolution: int | None,
    force: bool,
    as_json: bool,
    listen: Listener,
) -> None:
    """Write the grid, and say what it is."""
    from nispcodec.core.progress import Progress

    started = time.monotonic()
    refuse_overwriting([output], force)
    listen(Progress(stage="surface", overall=0.0))
    grid = model.sdf_grid(samples, resolution)
    grid.save(output, listen)
    warn(grid.warnings)
    seconds = round(time.monotonic() - started, 1)
    report = {
        "file": str(output),
        "samples": list(grid.shape),
        "origin": list(grid.origin),
        "spacing": grid.spacing,
        "files": listed([output]),
        "warnings": list(grid.warnings),
        "seconds": seconds,
    }
    if as_json:
        print_json(report)
        return
    shape = " x ".join(map(str, grid.shape))
    click.echo(f"{output}: {shape} distances, {grid.spacing:.6g} apart, in {duration(seconds)}")
    print_written([output], "  ")
