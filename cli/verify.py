"""`nisp verify`: is a `.nisp` file sound?"""

from __future__ import annotations

from pathlib import Path

import click

from .report import print_json


@click.command("verify", short_help="Check a .nisp file.")
@click.argument("model", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
@click.pass_context
def command(ctx: click.Context, model: Path, as_json: bool) -> None:
    """Check MODEL: structure, checksums, caps, canonical form, finite weights, images.

    The exit code is 0 if it is sound and 1 if not.

    \b
    Example: nisp verify model.nisp
    """
    from nispcodec.core.texture import decode_image
    from nispcodec.format.verify import verify

    problems = verify(model.read_bytes(), decode_image)
    if as_json:
        names = ("section", "field", "expected", "found")
        listed = [{name: str(getattr(each, name)) for name in names} for each in problems]
        print_json({"file": str(model), "sound": not problems, "problems": listed})
    elif problems:
        for problem in problems:
            click.echo(f"{model}: {problem}")
    else:
        click.echo(f"{model}: sound")
    ctx.exit(1 if problems else 0)
