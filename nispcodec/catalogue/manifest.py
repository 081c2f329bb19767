"""Manifests: assets and what is asked of each, as CSV or JSON Lines."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from nispcodec.catalogue.plan import Asset, Problem
from nispcodec.catalogue.settings import NAMES, Settings
from nispcodec.catalogue.storage import is_remote, joined, storage_of
from nispcodec.core.errors import NispError

SUFFIXES = (".csv", ".jsonl")
SOURCE, OUTPUT = "source", "output"
COLUMNS = (SOURCE, OUTPUT, *NAMES)


def read_manifest(place: str) -> Iterator[Asset | Problem]:
    """An asset for each line of a manifest, and a problem for each that makes no sense.

    A line has a `source`, relative to the manifest's folder, and may have an `output`, relative to
    the folder of the catalogue, and options by their Python names. A table has a head with these
    names; an empty cell says nothing. An asset without an output has "" there.
    """
    try:
        text = storage_of(place).read(place).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError, NispError) as why:
        yield Problem(place, f"expected a manifest in UTF-8, found: {why}")
        return
    lines = _of_table(text) if place.lower().endswith(".csv") else _of_json(text)
    for number, found in lines:
        where = f"{place} line {number}"
        try:
            yield _asset(found if isinstance(found, dict) else {}, place)
        except NispError as why:
            said = found if isinstance(found, str) else str(why)
            yield Problem(where, said)


def _of_table(text: str) -> Iterator[tuple[int, dict[str, Any] | str]]:
    """Line numbers, and what each says; a sentence for one that says nothing."""
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    head = next(reader, [])
    if unknown := [name for name in head if name not in COLUMNS]:
        yield 1, f"expected columns of {', '.join(COLUMNS)}, found {unknown[0]!r}"
        return
    if SOURCE not in head:
        yield 1, f"expected a column {SOURCE}, found {', '.join(head) or 'none'}"
        return
    try:
        for cells in reader:
            if len(cells) == len(head):
                said = zip(head, cells, strict=True)
                yield reader.line_num, {name: cell for name, cell in said if cell != ""}
            elif cells:
                yield reader.line_num, f"expected {len(head)} cells, found {len(cells)}"
    except csv.Error as why:
        yield reader.line_num, f"expected a line of CSV, found: {why}"


def _of_json(text: str) -> Iterator[tuple[int, dict[str, Any] | str]]:
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip():
            continue
        try:
            found = json.loads(line)
        except (ValueError, RecursionError) as why:
            yield number, f"expected JSON, found: {why}"
            continue
        is_map = isinstance(found, dict)
        yield number, found if is_map else f"expected an object, found {line[:40]!r}"


def _asset(found: Mapping[str, Any], manifest: str) -> Asset:
    """Raises NispError, in words, for a line that makes no sense."""
    options = {name: value for name, value in found.items() if name not in (SOURCE, OUTPUT)}
    source, output = found.get(SOURCE), found.get(OUTPUT, "")
    if not isinstance(source, str) or not source or "\0" in source:
        raise NispError(f"{SOURCE}: expected a path, found {source!r}")
    if not isinstance(output, str):
        raise NispError(f"{OUTPUT}: expected a path, found {output!r}")
    if output and not output.endswith(".nisp"):
        raise NispError(f"{OUTPUT}: expected a path that ends with .nisp, found {output!r}")
    if output:
        joined("", output)
    Settings().changed(options)
    return Asset(_beside(source, manifest), output, options=options)


def _beside(source: str, manifest: str) -> str:
    if is_remote(source):
        return source
    if is_remote(manifest):
        return f"{manifest.rpartition('/')[0]}/{source}"
    return str(Path(manifest).parent / source)
