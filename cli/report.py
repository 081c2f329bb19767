"""What a `.nisp` file's bytes are spent on, and how numbers are printed."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click


def rate(data: bytes) -> dict[str, int]:
    """The bytes of a container: geometry+UV (networks, tables, header), textures, total."""
    from nispcodec.format import own_bytes

    own = own_bytes(data)
    return {"geometry_uv": own, "textures": len(data) - own, "total": len(data)}


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


def print_written(paths: list[Path], indent: str = "") -> None:
    """A line for each file that was written, with its bytes."""
    for path in paths:
        click.echo(f"{indent}{path}: {path.stat().st_size:,} bytes")


def print_rate(output: Path, data: bytes, as_json: bool) -> None:
    """What the bytes of a `.nisp` file that was written are spent on."""
    if as_json:
        print_json({"file": str(output), "bytes": rate(data)})
    else:
        print_group(str(output), rate(data))


def _unnamed(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name != "name"}


def number(value: Any) -> str:
    """Four significant digits; whole numbers with thousands apart; lists with commas."""
    if isinstance(value, list | tuple):
        return ", ".join(number(each) for each in value)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, int | float):
        return str(value)
    if isinstance(value, int):
        return f"{value:,}"
    return f"{value:.4g}"
