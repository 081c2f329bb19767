"""Records of the NAME.nisp files in a folder, kept in one JSON file; each is of certain bytes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from functools import reduce
from hashlib import sha256
from pathlib import Path

import click

from benchmarks.machine import machine, versions
from benchmarks.target import Record
from nispcodec.output import write_atomic

Command = Callable[..., None]


def models_options(results: Path) -> Callable[[Command], Command]:
    """The options `models`, `assets`, `only` and `output` of a command, which keeps `results`."""
    folder = click.Path(path_type=Path, exists=True)
    options = (
        click.option("--models", type=folder, required=True, help="A folder of NAME.nisp."),
        click.option("--assets", type=folder, required=True, help="A folder of NAME/NAME.obj."),
        click.option("--only", multiple=True, help="An asset; may be repeated."),
        click.option("-o", "--output", type=Path, default=results, show_default=True),
    )
    return lambda command: reduce(lambda made, option: option(made), reversed(options), command)


def digest(path: Path) -> str:
    """What tells one model's bytes from another's; the "model" of a record."""
    return sha256(path.read_bytes()).hexdigest()


def known(output: Path) -> Record:
    """The records so far, by the names of assets."""
    records: Record = json.loads(output.read_text())["assets"] if output.exists() else {}
    return records


def unmeasured(models: Path, only: tuple[str, ...], records: Record) -> Iterator[Path]:
    """The models to measure, told one by one: of those asked for, what has no record yet."""
    for path in sorted(models.glob("*.nisp")):
        wanted = not only or path.stem in only
        if wanted and records.get(path.stem, {}).get("model") != digest(path):
            click.echo(f"{path.stem} ...", err=True)
            yield path


def keep(output: Path, records: Record, **more: object) -> None:
    """Write all records, with where they were measured and whatever else belongs to them."""
    output.parent.mkdir(parents=True, exist_ok=True)
    everything = {"machine": machine(), "versions": versions(), **more, "assets": records}
    write_atomic(output, json.dumps(everything, indent=1).encode() + b"\n")
