"""`format_spec.md` taken apart: its tables, its hexdumps, its decoder."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

TEXT = (Path(__file__).parents[2] / "format_spec.md").read_text()


def blocks(language: str) -> list[str]:
    """The fenced blocks of one language."""
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


@cache
def table_after(heading: str) -> list[list[str]]:
    """The rows of the first table after a line with this text, header and rule left out."""
    start = TEXT.index(heading)
    rows = TEXT[start:].splitlines()[1:]
    first = next(i for i, line in enumerate(rows) if line.startswith("|"))
    found = []
    for line in rows[first + 2 :]:
        if not line.startswith("|"):
            break
        found.append([cell.strip() for cell in line.strip("|").split("|")])
    return found


def enumeration(name: str) -> tuple[str, ...]:
    """The names of an enumeration, whose numbers must count from 1."""
    rows = table_after(f"Enumeration `{name}`")
    assert [int(row[0]) for row in rows] == list(range(1, len(rows) + 1))
    return tuple(row[1] for row in rows)


def fields(name: str) -> set[tuple[int, str]]:
    """Key and name of every field of a map."""
    return {(int(row[0]), row[1]) for row in table_after(f"Fields of `{name}`")}


def example() -> bytes:
    """The whole file of section 10."""
    return bytes.fromhex("".join(line[6:] for line in blocks("hexdump")[0].splitlines()))


def decoder() -> dict[str, Any]:
    """The names that the spec's own Python defines."""
    names: dict[str, Any] = {}
    for block in blocks("python"):
        exec(block, names)
    return names
