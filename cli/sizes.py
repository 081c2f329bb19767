"""Numbers of bytes as people write them."""

from __future__ import annotations

import re

import click

UNITS = {
    "": 1,
    "b": 1,
    "kb": 1000,
    "mb": 1000_000,
    "gb": 1000**3,
    "kib": 1024,
    "mib": 1024**2,
    "gib": 1024**3,
}


def parsed_size(
    context: click.Context, parameter: click.Parameter, value: str | None
) -> float | None:
    """Bytes: 12000, 12kB, 12.5 KiB."""
    if value is None:
        return None
    found = re.fullmatch(r"([0-9.]+) *([a-z]*)", value.strip().lower())
    try:
        if found:
            return float(found[1]) * UNITS[found[2]]
    except (KeyError, ValueError):
        pass
    said = f"expected a size such as 20000, 20kB or 20KiB, found {value!r}"
    raise click.BadParameter(said, context, parameter)
