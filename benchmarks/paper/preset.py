"""The `paper` preset on one asset, with its curve: held-out error against steps and seconds.

    python -m benchmarks.paper.preset ../shared/assets/spot/spot.obj [--keep spot.nisp]

The paper trains on 2 x 10^9 samples a network; the preset stops where some twenty minutes on two
cores end. Writes the curve, the held-out measurements and the size beside the published numbers.
"""

from __future__ import annotations

import time
from pathlib import Path

import click

import nispcodec
from benchmarks.measuring.machine import commit, machine, versions
from benchmarks.measuring.result_file import Record, as_json, write_result
from nispcodec.core.progress import Progress
from nispcodec.encode.config import Tuning
from nispcodec.format import own_bytes, pack
from nispcodec.io.load import load_mesh
from nispcodec.train.config import PaperConfig, TrainConfig

RESULTS = Path("benchmarks/results/paper_preset.json")
POINTS = 100

PUBLISHED = {
    "samples per network": 2e9,
    "weight bytes, unpruned": 487e3,
    "chart accuracy (Mario)": 0.989,
    "UV error (Mario)": 3e-4,
    "training hours on an RTX 2070 SUPER": 1.65,
}


class Curve:
    """Remembers (network, step, seconds, held-out error), some POINTS a network."""

    def __init__(self) -> None:
        self.started = time.monotonic()
        self.points: dict[str, list[tuple[int, float, float]]] = {}

    def __call__(self, update: Progress) -> None:
        """Keep the update when it is time for another point."""
        known = self.points.setdefault(update.network or "stages", [])
        if update.network and update.step * POINTS >= update.steps * (len(known) + 1):
            known.append((update.step, round(time.monotonic() - self.started, 1), update.error))


def measure(source: Path, steps: int, keep: Path | None) -> Record:
    """Encode with the preset; `keep`: where to write the file, which has the textures too."""
    training = TrainConfig(paper=PaperConfig(steps=steps))
    curve = Curve()
    config = nispcodec.EncodeConfig(preset="paper")
    model = nispcodec.encode(load_mesh(source), config, curve, Tuning(training=training))
    if keep is not None:
        nispcodec.save(model, keep)
    return {
        "asset": source.stem,
        "steps": steps,
        "samples_per_network": steps * 2048,
        "seconds": round(time.monotonic() - curve.started, 1),
        "bytes": own_bytes(pack(model.document)),
        "measured": dict(model.document.info),
        "published": PUBLISHED,
        "curve": {name: points for name, points in curve.points.items() if points},
    }


@click.command()
@click.argument("source", type=click.Path(path_type=Path, exists=True))
@click.option("-o", "--output", type=click.Path(path_type=Path), default=RESULTS, show_default=True)
@click.option("--steps", type=click.IntRange(1), default=PaperConfig.steps, show_default=True)
@click.option("--keep", type=click.Path(path_type=Path), help="Where to write the file as well.")
def main(source: Path, output: Path, steps: int, keep: Path | None) -> None:
    """Run the preset on SOURCE and write the JSON."""
    result = {
        "commit": commit(),
        "machine": machine(),
        "versions": versions(),
        **measure(source, steps, keep),
    }
    write_result(output, result)
    click.echo(as_json({key: value for key, value in result.items() if key != "curve"}))


if __name__ == "__main__":
    main()
