"""`nisp view`: a `.nisp` file in the browser."""

from __future__ import annotations

import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .outputs import OutputFile, refuse_overwriting
from .report import print_json, print_written
from .sources import Source, model_argument, parsed, read_mesh
from .subcommand import force_option, json_option, subcommand

if TYPE_CHECKING:
    from nispcodec.core.document import Frame


def page_suffix() -> tuple[str, ...]:
    """That of a page."""
    return (".html",)


@subcommand("view", "Look at a .nisp file in the browser.")
@model_argument
@click.option(
    "-o",
    "--output",
    type=OutputFile(page_suffix),
    help="Write the page in place of showing it: one file, to mail or to put on a site.",
)
@click.option(
    "--original",
    type=click.Path(path_type=Path),
    metavar="MESH",
    help="The mesh that it was made from, side by side.",
)
@click.option("--no-browser", is_flag=True, help="Say the page's address only.")
@force_option
@json_option
def command(
    model: Source,
    output: Path | None,
    original: Path | None,
    no_browser: bool,
    force: bool,
    as_json: bool,
) -> None:
    """Show MODEL (.nisp, or - for standard input) in the browser, as a mesh or as its field.

    The page holds the decoder and the file, and uses no network. Without -o it is served to this
    machine alone until Ctrl-C.

    \b
    Example: nisp view model.nisp
             nisp view model.nisp -o page.html --original model.glb
    """
    if output:
        refuse_overwriting([output], force)
    page = _page(model, original)
    if output is None:
        _serve(page, no_browser, as_json)
        return
    from nispcodec.core.atomic_write import write_atomic

    write_atomic(output, page.encode())
    if as_json:
        print_json({"file": str(output), "bytes": len(page.encode())})
    else:
        print_written([output])


def _page(model: Source, original: Path | None) -> str:
    """The page of a file that was checked."""
    from nispcodec_web.page import viewer_page

    data = model.read()
    document = parsed(data, model)
    title = model.path.name if model.path else "model.nisp"
    page: str = viewer_page(data, title, _original(original, document.frame))
    return page


def _original(path: Path | None, frame: Frame) -> dict[str, Any] | None:
    if path is None:
        return None
    from nispcodec_web.page import original_data

    found: dict[str, Any] = original_data(read_mesh(path), frame)
    return found


def _serve(page: str, no_browser: bool, as_json: bool) -> None:
    """Serve the page until Ctrl-C, which is how it is meant to end."""
    from nispcodec_web.server import PageServer

    with PageServer(page) as server:
        if as_json:
            print_json({"address": server.address})
        else:
            click.echo(f"{server.address} (Ctrl-C ends it)")
        if not no_browser:
            webbrowser.open(server.address)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            click.echo("", err=True)
