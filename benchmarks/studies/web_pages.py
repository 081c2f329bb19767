"""The page of `nisp view -o` in headless Chromium: seconds to its first picture, calls a ray.

    python -m benchmarks.studies.web_pages --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME. Wants node, Chromium, and playwright-core by `npm ci` in
web/. Seconds are from the start of navigation on, the least of several runs: Chromium draws without
a graphics processor, and other programs slow it. Calls are those of the signed distance's network
while a ray is traced, in the mean of all pixels: in the field's view, and by a sphere tracer that
knows no free space and steps by the field over its steepest slope. Results are kept asset by asset.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import click
from nispcodec_web.page import viewer_page

from benchmarks.measuring.build import HERE
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each

RESULTS = Path("benchmarks/results/web_pages.json")
CELLS = (128, 256)
CHOSEN = 'value="128"'
"""What the page says of the cells that it starts with."""
RUNS = 7
PICTURE = 96
"""Pixels along an edge of the picture whose calls are counted."""
SPOT = [
    Target("first picture, 128 cells, s", ("first_picture_seconds", "128"), 1),
    Target("first picture, 256 cells, s", ("first_picture_seconds", "256"), 3),
]
FIELDS = [Target("calls a ray / plain tracer", ("calls_over_plain",), 0.5)]


def asked(result: Record) -> Iterator[Asked]:
    """The targets of the asset that they name, and those of all with a field."""
    assets = result["assets"]
    fields = {name: each for name, each in assets.items() if "calls_a_ray" in each}
    yield from asked_of_each({"spot": assets.get("spot", {})}, lambda _: SPOT)
    yield from asked_of_each(fields, lambda _: FIELDS)


@click.command(help=__doc__)
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure what is not measured yet."""
    for name, found in measured(models, assets, only, output, record).items():
        click.echo(f"{name}: {found['first_picture_seconds']} s")


def record(model: Path, original: Path) -> Record:
    """What Chromium says of the page of one file."""
    page = viewer_page(model.read_bytes(), model.stem)
    assert page.count(CHOSEN) == 1
    pages = {cells: page.replace(CHOSEN, f'value="{cells}"') for cells in CELLS}
    found = {str(cells): _in_chromium(each) for cells, each in pages.items()}
    seconds = {cells: min(each["seconds"]) for cells, each in found.items()}
    kept: Record = {"page_bytes": len(page), "first_picture_seconds": seconds}
    if calls := found[str(CELLS[0])]["calls"]:
        kept |= {"calls_a_ray": calls, "calls_over_plain": calls["viewer"] / calls["plain"]}
    return kept


def _in_chromium(page: str) -> Record:
    """What web_pages.mjs says. Raises click.ClickException without Chromium."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        raise click.ClickException("chromium: expected it on the path, found none")
    script = HERE / "benchmarks" / "studies" / "web_pages.mjs"
    with TemporaryDirectory() as folder:
        path = Path(folder, "page.html")
        path.write_text(page)
        command = ["node", str(script), chromium, str(path), str(RUNS), str(PICTURE)]
        run = subprocess.run(command, capture_output=True, text=True, check=True)
    found: Record = json.loads(run.stdout)
    return found


if __name__ == "__main__":
    main()
