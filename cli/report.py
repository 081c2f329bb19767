"""What a `.nisp` file's bytes are spent on, and how numbers are printed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import click


def rate(data: bytes) -> dict[str, int]:
    """The bytes of a container: geometry+UV (networks, tables, header), textures, total."""
    from nispcodec.format import inspect
    from nispcodec.format.constants import TXTR

    textures = sum(each.stored_length for each in inspect(data) if each.code == TXTR)
    return {"geometry_uv": len(data) - textures, "textures": textures, "total": len(data)}


def print_json(value: object) -> None:
    """One JSON document on standard output."""
    click.echo(json.dumps(value, indent=2, allow_nan=False))


def print_group(title: str, values: Mapping[str, Any], indent: str = "") -> None:
    """A titled list of names and values; maps, and lists of maps with a "name", are indented."""
    click.echo(f"{indent}{title}")
    for name, value in values.items():
        if isinstance(value, Mapping):
            print_group(name, value, indent + "  ")
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            click.echo(f"{indent}  {name}")
            for each in value:
                print_group(each["name"], _unnamed(each), indent + "    ")
        else:
            click.echo(f"{indent}  {name:<22} {number(value)}")


def _unnamed(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name != "name"}


def number(value: Any) -> str:
    """Four significant digits; whole numbers with thousands apart."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:.4g}"
