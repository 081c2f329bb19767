"""What rounding the weights costs on the decoded mesh: beside the same fits, left as floats.

    python -m benchmarks.studies.rounding_loss --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp as `nisp encode` writes them here with this code. An encode with their preset
and seed is the same up to the rounding. Results are kept asset by asset.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click

import nispcodec
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target, asked_of_each
from nispcodec import EncodeConfig
from nispcodec.core.network import Network
from nispcodec.encode import field_form
from nispcodec.io.load import load_mesh
from nispcodec.metrics.compare import Reference
from nispcodec.model import NispModel
from nispcodec.train.task import Task
from nispcodec.train.workers import fit_networks

RESULTS = Path("benchmarks/results/rounding_loss.json")
PLACES = {
    "distance": ("geometry", "larger", "mean"),
    "uv median": ("uv", "larger", "median"),
    "uv mean": ("uv", "larger", "mean"),
}
TARGETS = [Target(f"{name}: after / before", ("ratios", name), 1.15) for name in PLACES]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset in a result file."""
    return asked_of_each(results["assets"], lambda _: TARGETS)


@contextmanager
def floats() -> Iterator[None]:
    """Encodes within it leave their weights as they were fitted."""

    def fit(tasks: list[Task], *how: Any) -> dict[str, Network]:
        return fit_networks([replace(task, quantization=None) for task in tasks], *how)

    with patch.object(field_form, "fit_networks", fit):
        yield


def errors(reference: Reference, model: NispModel) -> dict[str, float]:
    """The errors of `PLACES` of the decoded mesh."""
    report = reference.compare(model.to_mesh(), model)
    found = {name: Target(name, place, 0).measured(report) for name, place in PLACES.items()}
    return {**found, "charts": Target("charts", ("charts", "accuracy"), 0).measured(report)}


def measure(path: Path, source: Path) -> Record:
    """Both models of one asset, and how much worse the rounded one is."""
    mesh, rounded = load_mesh(source), nispcodec.load(path)
    info = rounded.document.info
    reference = Reference.of(mesh)
    with floats():
        before = nispcodec.encode(mesh, EncodeConfig(str(info["preset"]), int(info["seed"])))
    found = {"before": errors(reference, before), "after": errors(reference, rounded)}
    ratios = {name: found["after"][name] / found["before"][name] for name in PLACES}
    return {**found, "ratios": ratios}


@click.command()
@models_options(RESULTS)
def main(models: Path, assets: Path, only: tuple[str, ...], output: Path) -> None:
    """Measure every NAME.nisp in MODELS and print asked against measured."""
    for name, record in measured(models, assets, only, output, measure).items():
        charts = (record[when]["charts"] for when in ("before", "after"))
        click.echo("{:<18}charts right: {:.4f} before, {:.4f} after".format(name, *charts))
        for target in TARGETS:
            click.echo(target.line(name, record))


if __name__ == "__main__":
    main()
