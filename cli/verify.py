"""`nisp verify`: is a `.nisp` file sound?"""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from .report import print_json
from .sources import Source, model_argument, no_nisp
from .subcommand import json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.errors import FormatError


@subcommand("verify", "Check a .nisp file.")
@model_argument
@json_option
@click.pass_context
def command(ctx: click.Context, model: Source, as_json: bool) -> None:
    """Check MODEL (.nisp, or - for standard input).

    Structure, checksums, caps, canonical form, finite weights, images. The exit code is 0 if it is
    sound, 1 if not, 2 if it cannot be read.

    \b
    Example: nisp verify model.nisp
    """
    from nispcodec.core.texture import decode_image
    from nispcodec.format.verify import verify

    data = model.read()
    problems = verify(data, decode_image)
    if as_json:
        faults = [_fault(each) for each in problems]
        print_json({"file": str(model), "sound": not problems, "problems": faults})
    else:
        _print_problems(model, no_nisp(data), problems)
    ctx.exit(1 if problems else 0)


def _fault(problem: FormatError) -> dict[str, str]:
    names = ("section", "field", "expected", "found")
    return {name: str(getattr(problem, name)) for name in names}


def _print_problems(model: Source, wrong: str, problems: list[FormatError]) -> None:
    """`wrong`: what is said of a file that is no `.nisp` at all."""
    said = [wrong] if wrong else [str(each) for each in problems] or ["sound"]
    for each in said:
        click.echo(f"{model}: {each}")
