"""Output files are refused before the work when they cannot be written."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import click


def output_option(*suffixes: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The option `-o`: a file of one of the suffixes in a folder that can be written.

    Checked before the work, so that no long work is lost for a typing error.
    """

    def checked(ctx: click.Context, param: click.Parameter, path: Path) -> Path:
        if path.suffix.lower() not in suffixes:
            found = path.suffix or "no suffix"
            raise click.BadParameter(f"{path}: expected {', '.join(suffixes)}, found {found}")
        if path.is_dir() or not os.access(path.parent, os.W_OK):
            raise click.BadParameter(f"{path}: expected a file in a folder that can be written")
        return path

    kind = click.Path(path_type=Path)
    text = ", ".join(suffixes)
    return click.option("-o", "--output", type=kind, required=True, callback=checked, help=text)
