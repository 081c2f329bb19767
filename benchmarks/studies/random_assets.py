"""Random assets through every preset: none may end in an error.

    python -m benchmarks.studies.random_assets [--count 50] [--share 0.1] [--presets fast,best]
        [--write benchmarks/results/random_assets.json]

Turned bodies of random profiles, closed or open, and wavy sheets; one to four in an asset, each
with one or two charts. `--share` of a preset's samples and steps, as whole fits of fifty assets
take an hour; probes are whole, or all assets would seem to be of fine detail.
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import click
import numpy as np

import nispcodec
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, as_json, write_result
from benchmarks.measuring.target import Asked, Target
from nispcodec import EncodeConfig, NispError, Progress, TexturedMesh
from nispcodec.core.arrays import Float64Array, Int32Array
from nispcodec.encode.config import Tuning

ROWS, COLUMNS = 24, 40
Surface = tuple[Float64Array, Float64Array]
"""Positions (rows + 1, columns + 1, 3) and UVs (rows + 1, columns + 1, 2) of a grid."""


@click.command()
@click.option("--first", default=0, show_default=True, help="Number of the first asset.")
@click.option("--count", default=50, show_default=True)
@click.option("--share", default=0.1, show_default=True, help="Of samples and steps.")
@click.option("--presets", default="fast,balanced,best", show_default=True)
@click.option("--threads", default=0, help="Of an encode; 0: all. Few on a busy machine.")
@click.option("--write", type=click.Path(path_type=Path), help="The result file.")
def main(
    first: int, count: int, share: float, presets: str, threads: int, write: Path | None
) -> None:
    """Encode them all; exits with 1 when one fails."""
    where = {"commit": commit(), "machine": machine(), "versions": versions()}
    records = list(runs(range(first, first + count), share, presets.split(","), threads))
    failed = sum("error" in record for record in records)
    result = where | {"share": share, "failed": failed, "encodes": records}
    if write:
        write_result(write, result)
    print(as_json(result))
    raise SystemExit(failed > 0)


def asked(results: Record) -> Iterator[Asked]:
    """No encode may fail."""
    yield Asked("all", Target("encodes that failed", ("failed",), 0), results)


def runs(
    numbers: Iterable[int], share: float, presets: list[str], threads: int = 0
) -> Iterator[Record]:
    """A record for every asset and preset."""
    for number in numbers:
        mesh = random_asset(np.random.default_rng(number))
        for preset in presets:
            config = EncodeConfig(preset, number, threads=threads)
            found = encoded(mesh, config, share)
            click.echo(f"{number} {preset} {found}", err=True)
            yield {"asset": number, "preset": preset, **found}


def encoded(mesh: TexturedMesh, config: EncodeConfig, share: float) -> Record:
    """What the encoder measured, its warnings and seconds; or the error."""
    notes: list[str] = []

    def heard(update: Progress) -> None:
        if update.warning or "diverged" in update.note:
            notes.append(f"{update.network} {update.warning}{update.note}")

    started = time.monotonic()
    try:
        model = nispcodec.encode(mesh, config, heard, shortened(share))
    except NispError as error:
        return {"error": str(error)}
    seconds = round(time.monotonic() - started, 1)
    return {"seconds": seconds, "notes": notes, **model.document.info}


def shortened(share: float) -> Tuning:
    """The usual numbers, with a share of the samples and steps."""
    usual = Tuning()
    budgets = {
        name: replace(budget, steps=max(1, round(share * budget.steps)))
        for name, budget in usual.training.budgets.items()
    }
    training = replace(usual.training, budgets=budgets)
    return replace(usual, training=training, sampling=usual.sampling.shared(share))


def random_asset(random: np.random.Generator) -> TexturedMesh:
    """One to four surfaces, here and there, of different sizes."""
    parts = [random_surface(random) for _ in range(random.integers(1, 5))]
    faces = np.concatenate([grid_faces(number) for number in range(len(parts))])
    cut = (faces % COLUMNS).min(axis=1) < COLUMNS // 2
    two = random.random() < 0.5
    uvs = np.concatenate([uv.reshape(-1, 2) for _, uv in parts])
    return TexturedMesh(
        positions=np.concatenate([position.reshape(-1, 3) for position, _ in parts]),
        faces=faces,
        uvs=np.concatenate([uvs, uvs + 1.5]),
        uv_faces=np.where((two & cut)[:, None], faces + len(uvs), faces).astype(np.int32),
        face_materials=np.zeros(len(faces), np.int32),
    )


def random_surface(random: np.random.Generator) -> Surface:
    """A turned body or a wavy sheet, turned and moved."""
    down, across = np.meshgrid(
        np.linspace(0, 1, ROWS + 1), np.linspace(0, 1, COLUMNS + 1), indexing="ij"
    )
    shape = turned_body if random.random() < 0.7 else wavy_sheet
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    placed = shape(random, down, across) @ axes * random.uniform(0.3, 1) + random.uniform(-1, 1, 3)
    corner, size = random.uniform(0, 0.5, 2), random.uniform(0.2, 0.5)
    return placed, corner + size * np.stack([across, down], axis=2)


def turned_body(
    random: np.random.Generator, down: Float64Array, across: Float64Array
) -> Float64Array:
    """A profile of a few waves around an axis; open at its ends in one of three."""
    waves = sum(random.normal() / k * np.sin(k * np.pi * down + random.normal()) for k in (1, 2, 3))
    radius = 0.2 + np.abs(waves) * (1 if random.random() < 1 / 3 else np.sin(np.pi * down))
    angle = 2 * np.pi * across
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 2 * down - 1], axis=2)


def wavy_sheet(
    random: np.random.Generator, down: Float64Array, across: Float64Array
) -> Float64Array:
    """A square with waves."""
    counts = random.integers(1, 6, 2)
    waves = np.sin(counts[0] * np.pi * across) * np.cos(counts[1] * np.pi * down)
    return np.stack([2 * across - 1, 2 * down - 1, random.uniform(0, 0.3) * waves], axis=2)


def grid_faces(number: int) -> Int32Array:
    """Two triangles a cell of the grid with this number."""
    grid = np.arange((ROWS + 1) * (COLUMNS + 1), dtype=np.int32).reshape(ROWS + 1, COLUMNS + 1)
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3) + np.int32(number * grid.size)


if __name__ == "__main__":
    main()
