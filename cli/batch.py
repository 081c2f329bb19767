"""`nisp batch`: many assets, side by side, into a catalogue that can be gone on with."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from contextlib import closing
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .batch_progress import Reporter, batch_reporter
from .choices import LibraryChoice, batch_engines, engines
from .encode import command as encode
from .outputs import make_folder
from .ranges import Real, Whole
from .sizes import parsed_size
from .subcommand import subcommand

if TYPE_CHECKING:
    from nispcodec.catalogue.batch import Batch
    from nispcodec.catalogue.plan import Asset, Problem, Shard

ENCODE_NAMES = (
    "preset", "geometry", "target_size", "target_total", "target_error", "seed", "device", "unwrap",
    "pad_textures", "texture_format", "texture_quality", "prune", "prune_rate", "prune_rounds",
    "no_textures",
)  # fmt: skip
"""Options that are those of `nisp encode`; its --engine is --backend here, its --threads --jobs."""
PARTIAL = 3
"""Exit code when something failed and the rest is done."""


def _shard(context: click.Context, parameter: click.Parameter, value: str | None) -> Shard | None:
    """`3/8`."""
    from nispcodec.catalogue.plan import Shard

    if value is None:
        return None
    number, _, count = value.partition("/")
    if not (number.isdigit() and count.isdigit()):
        raise click.BadParameter(f"expected I/N such as 3/8, found {value!r}", context, parameter)
    return Shard(int(number), int(count))


@subcommand("batch", "Encode many meshes into a catalogue.")
@click.argument("inputs", nargs=-1, metavar="INPUT...")
@click.option(
    "-o", "--output", required=True, metavar="FOLDER", help="Of the catalogue; a path or a URL."
)
@click.option("--include", multiple=True, metavar="GLOB", help="Of names or paths in a folder.")
@click.option("--exclude", multiple=True, metavar="GLOB", help="What is left out all the same.")
@click.option("--jobs", type=Whole(0), default=0, help="Assets at a time, a core each; 0: all.")
@click.option(
    "--timeout", type=Real(0), default=0, metavar="SECONDS", help="For one asset; 0: none."
)
@click.option(
    "--memory",
    callback=parsed_size,
    metavar="SIZE",
    help="For one asset, such as 4GB; its share of the machine's unless told.",
)
@click.option("--retries", type=Whole(0), default=1, show_default=True, help="After a crash.")
@click.option("--thumbnail", type=Whole(0, 512), default=96, show_default=True, help="0: none.")
@click.option("--compare", is_flag=True, help="Decode and measure each, as nisp compare does.")
@click.option("--viewer", default="", metavar="URL", help="A page that shows ?file=NISP.")
@click.option(
    "--engine",
    type=LibraryChoice(batch_engines),
    default="processes",
    show_default=True,
    help="Of this machine, or a Ray cluster.",
)
@click.option("--address", default="", help="Of the Ray cluster; one of this machine unless told.")
@click.option("--shard", callback=_shard, metavar="I/N", help="One of N parts of the assets.")
@click.option("--merge", is_flag=True, help="Join what all shards left; encodes nothing.")
@click.option(
    "--backend",
    type=LibraryChoice(engines),
    default="auto",
    show_default=True,
    help="What trains; nisp encode calls it --engine.",
)
@click.option(
    "--metrics",
    type=click.Path(path_type=Path),
    help="Write OpenMetrics text to this file, again and again.",
)
@click.option("--quiet", is_flag=True, help="Say what fails, and the end.")
@click.option("--json", "as_json", is_flag=True, help="A line of JSON for each asset, and the end.")
def command(
    inputs: tuple[str, ...],
    output: str,
    include: tuple[str, ...],
    exclude: tuple[str, ...],
    merge: bool,
    metrics: Path | None,
    quiet: bool,
    as_json: bool,
    **how: Any,
) -> None:
    """Encode every INPUT into FOLDER, as nisp encode does, several at a time.

    INPUT is a mesh file, a folder, a glob in quotes, a manifest (.csv, .jsonl), a URL, or - for
    paths on standard input. What is done already is kept: the same command goes on where it was
    stopped. catalogue.jsonl has a line for each asset, catalogue.html shows them all. The exit code
    is 0 if all are done, 3 if some failed.

    \b
    Example: nisp batch models -o out --preset fast
             nisp batch "scans/**/*.glb" list.csv -o out --timeout 600 --memory 4GB
             find models -name "*.obj" | nisp batch - -o out
    """
    ctx = click.get_current_context()
    reporter = batch_reporter(quiet, as_json, metrics)
    if merge:
        ctx.exit(_merged(inputs, output, how["viewer"], reporter))
    if not inputs:
        raise click.UsageError("INPUT: expected some, found none", ctx)
    batch = _batch(output, how)
    found = _found(inputs, include, exclude)
    with closing(batch.run(found, reporter.tick, reporter.warn)) as results:
        for result in results:
            reporter.result(result)
    assert batch.driver is not None
    reporter.end(batch.driver.tally, batch.driver.stopped)
    ctx.exit(PARTIAL if batch.driver.stopped or reporter.failures else 0)


command.params += [each for each in encode.params if each.name in ENCODE_NAMES]


def _batch(output: str, how: dict[str, Any]) -> Batch:
    from nispcodec.catalogue.batch import Batch
    from nispcodec.catalogue.config import BatchConfig
    from nispcodec.catalogue.settings import Settings
    from nispcodec.catalogue.storage import is_remote
    from nispcodec.encode.config import EncodeConfig

    memory = int(how.pop("memory") or 0)
    own = {each.name for each in fields(BatchConfig)} & set(how)
    config = BatchConfig(**{name: how.pop(name) for name in own}, memory=memory)
    shard, viewer, unwrap = how.pop("shard"), how.pop("viewer"), how.pop("unwrap")
    textures = not how.pop("no_textures")
    encode = EncodeConfig(engine=how.pop("backend"), textures=textures, **how)
    batch = Batch(output, Settings(encode, unwrap), config, shard, viewer)
    batch.expect_installed()
    if not is_remote(output):
        make_folder(Path(output))
    return batch


def _found(
    inputs: Sequence[str], include: tuple[str, ...], exclude: tuple[str, ...]
) -> list[Asset | Problem]:
    from nispcodec.catalogue.find import Patterns, find_assets

    listed = map(os.fsdecode, sys.stdin.buffer)
    return list(find_assets(inputs, Patterns(include, exclude), listed))


def _merged(inputs: Sequence[str], output: str, viewer: str, reporter: Reporter) -> int:
    from nispcodec.catalogue.ledger import merge
    from nispcodec.catalogue.lock import locked
    from nispcodec.catalogue.page import write_page

    if inputs:
        raise click.UsageError("--merge: expected no INPUT beside it, found one")
    folder = Path(output)
    with locked(folder):
        records, warnings = merge(folder)
        write_page(output, records, viewer)
    for each in warnings:
        reporter.warn(each)
    failed = sum(not each.done for each in records.values())
    reporter.merged(len(records) - failed, failed)
    return PARTIAL if failed or warnings else 0
