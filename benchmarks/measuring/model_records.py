"""Records of the NAME.nisp files in a folder, kept in one JSON file; each is of certain bytes."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from hashlib import sha256
from pathlib import Path

import click

from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, result_so_far, write_result

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


def measured(
    models: Path,
    assets: Path,
    only: tuple[str, ...],
    output: Path,
    measure: Callable[[Path, Path], Record],
    **more: object,
) -> dict[str, Record]:
    """The records of all models ever measured into `output`, by the sorted names of assets.

    Those asked for that have none of these very bytes are measured, from the model's path and the
    original's, told one by one and kept at once, with the machine and whatever else belongs to it.
    """
    records: Record = result_so_far(output).get("assets", {})
    for path in sorted(models.glob("*.nisp")):
        name, bytes_now = path.stem, sha256(path.read_bytes()).hexdigest()
        if (only and name not in only) or records.get(name, {}).get("model") == bytes_now:
            continue
        click.echo(f"{name} ...", err=True)
        found = measure(path, assets / name / f"{name}.obj")
        records[name] = {"commit": commit(), "model": bytes_now, **found}
        everything = {"machine": machine(), "versions": versions(), **more, "assets": records}
        write_result(output, everything)
    return dict(sorted(records.items()))
