"""The paper's scatter charts: UVs of surface points as they are, and as two networks predict them.

    python -m benchmarks.paper.uv_scatter --models DIR --assets ../shared/assets [--only spot]

DIR holds NAME.nisp for the assets NAME, with networks. "conditioned" is the model itself, whose UV
network is told the predicted chart; "unconditioned" is one of the same layers that sees the point
alone, fitted with the same schedule. Results are kept asset by asset; one that has a result for the
same bytes is not measured again. The figure is drawn of all assets that were asked for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import nispcodec
from benchmarks.measuring.model_records import measured, models_options
from benchmarks.measuring.result_file import Record
from benchmarks.measuring.target import Asked, Target
from benchmarks.paper.pictures import unconditioned, without_charts
from nispcodec.core.arrays import BoolArray, Float64Array
from nispcodec.io.load import load_mesh
from nispcodec.metrics.sides import sides_of
from nispcodec.metrics.surface import Surface
from nispcodec.metrics.uv import uv_at, uv_summary
from nispcodec.model import NispModel

RESULTS, FIGURE = Path("benchmarks/results/paper_uv_scatter.json"), Path("docs/uv_scatter.png")
POINTS = 30_000
# A UV so far from the right one (a hundredth of the atlas) shows in the figure.
FAR = 0.01
NEAR_COLOR, FAR_COLOR = "#1f77b4", "#d62728"
DPI = 80

TARGETS = [
    Target("far UVs: conditioned / not", ("ratio", "far"), 1),
    Target("mean UV error: conditioned / not", ("ratio", "mean"), 1),
]


def asked(results: Record) -> Iterator[Asked]:
    """The targets of every asset of several charts in a result file."""
    for name, record in results["assets"].items():
        if record["charts"] > 1:
            yield from (Asked(name, target, record) for target in TARGETS)


@dataclass(frozen=True)
class Scatter:
    """UVs of the same n surface points: `right` (n, 2) and, by network, `predicted` (n, 2)."""

    right: Float64Array
    predicted: dict[str, Float64Array]

    def errors(self, network: str) -> Float64Array:
        """(n,): Euclidean distances in UV."""
        found: Float64Array = np.linalg.norm(self.predicted[network] - self.right, axis=1)
        return found

    def numbers(self, network: str) -> dict[str, float]:
        """Mean, median, 99th percentile, and the share that is `far`."""
        errors = self.errors(network)
        return {**uv_summary(errors), "far": float((errors > FAR).mean())}


def scatter(surface: Surface, models: dict[str, NispModel]) -> Scatter:
    """Of outer points that have UVs, spread evenly over the surface."""
    points = surface.sample(POINTS, np.random.default_rng(0))
    points = points[sides_of(surface, points).outer]
    points = points[surface.mesh.has_uv[points.faces]]
    places = points.positions.astype(np.float32)
    predicted = {
        name: model.uv(places, "normalized").astype(np.float64) for name, model in models.items()
    }
    return Scatter(uv_at(surface, points), predicted)


def draw(scatters: dict[str, Scatter], path: Path) -> None:
    """A row an asset; what is far from where it belongs is red."""
    titles = ("unconditioned", "conditioned", "original")
    figure = Figure(figsize=(3.0 * len(titles), 3.0 * len(scatters)), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(len(scatters), len(titles), squeeze=False, sharex="row", sharey="row")
    for row, (name, found) in zip(grid, scatters.items(), strict=True):
        for axes, title in zip(row, titles, strict=True):
            uvs = found.predicted.get(title, found.right)
            errors = found.errors(title) if title in found.predicted else np.zeros(len(uvs))
            _panel(axes, uvs, errors > FAR)
            axes.set_title(title, fontsize=9)
        row[0].set_ylabel(name, fontsize=9)
    figure.savefig(path, dpi=DPI)


def _panel(axes: Axes, uvs: Float64Array, far: BoolArray) -> None:
    for chosen, color in ((~far, NEAR_COLOR), (far, FAR_COLOR)):
        axes.scatter(uvs[chosen, 0], uvs[chosen, 1], s=0.6, color=color, linewidths=0)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])


def measure(model: NispModel, found: Scatter) -> Record:
    """The numbers of both networks, and the ratios of the model's to the other's."""
    numbers = {name: found.numbers(name) for name in found.predicted}
    ratios = {
        key: numbers["conditioned"][key] / max(numbers["unconditioned"][key], 1e-12)
        for key in numbers["conditioned"]
    }
    return {"charts": len(model.chart_materials), **numbers, "ratio": ratios}


@click.command()
@models_options(RESULTS)
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True)
@click.option("--threads", type=click.IntRange(1), default=2, show_default=True)
@click.option("--figure", type=click.Path(path_type=Path), default=FIGURE, show_default=True)
def main(
    models: Path,
    assets: Path,
    only: tuple[str, ...],
    output: Path,
    seed: int,
    threads: int,
    figure: Path,
) -> None:
    """Fit the unconditioned network of every NAME.nisp in MODELS, draw, and print the numbers."""
    scatters: dict[str, Scatter] = {}

    def measure_and_keep(path: Path, source: Path) -> Record:
        mesh, model = load_mesh(source), nispcodec.load(path)
        free = without_charts(model, unconditioned(mesh, model, seed, threads))
        surface = Surface.of(mesh, model.document.frame)
        scatters[path.stem] = scatter(surface, {"unconditioned": free, "conditioned": model})
        return measure(model, scatters[path.stem])

    records = measured(models, assets, only, output, measure_and_keep)
    if scatters:
        draw(dict(sorted(scatters.items())), figure)
    click.echo("\n".join(lines(records)))


def lines(records: dict[str, Record]) -> Sequence[str]:
    """The numbers of every asset, and asked against measured."""
    told = []
    for name, record in records.items():
        for network in ("unconditioned", "conditioned"):
            values = ", ".join(f"{key} {value:.3g}" for key, value in record[network].items())
            told.append(f"{name:<18}{network:<16}{values}")
    return [*told, *(each.line() for each in asked({"assets": records}))]


if __name__ == "__main__":
    main()
