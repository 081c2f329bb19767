"""The pruning figure, and the tables that go with it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.measuring.result_file import Record
from benchmarks.paper.pruning_published import PUBLISHED, RATES, SIZED, SIZES

Curve = list[tuple[float, float]]
"""(rate, accuracy or error), rising rates."""

STYLES = {
    "smallest": ("o", "#1f77b4"),
    "smallest_global": ("^", "#ff7f0e"),
    "large_final": ("x", "#2ca02c"),
}
LABELS = {"chart": "chart accuracy", "uv": "UV mean absolute error"}
WORSE = 0.1
DPI = 100


def curves(found: Sequence[Record]) -> dict[str, dict[str, dict[str, Curve]]]:
    """Title -> strategy -> network -> curve, the published first."""
    titles: dict[str, dict[str, dict[str, Curve]]] = {
        "published (Mario)": {
            strategy: {
                name: list(zip(RATES, values, strict=True)) for name, values in networks.items()
            }
            for strategy, networks in PUBLISHED.items()
        }
    }
    for each in found:
        titles.setdefault(each["asset"], {})[each["strategy"]] = {
            name: [(one["rate"], one["quality"]) for one in rounds]
            for name, rounds in each["rounds"].items()
        }
    return titles


def draw(found: Sequence[Record], path: Path) -> None:
    """Accuracy above, error below; published on the left, then asset by asset."""
    titles = curves(found)
    figure = Figure(figsize=(3.0 * len(titles), 5.0), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(2, len(titles), squeeze=False, sharex=True, sharey="row")
    for column, (title, strategies) in enumerate(titles.items()):
        for axes, name in zip(grid[:, column], LABELS, strict=True):
            _panel(axes, {each: networks[name] for each, networks in strategies.items()})
        grid[0, column].set_title(title, fontsize=9)
        grid[1, column].set_xlabel("pruned (%)", fontsize=8)
    grid[1, 0].set_yscale("log")
    for axes, label in zip(grid[:, 0], LABELS.values(), strict=True):
        axes.set_ylabel(label, fontsize=8)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False, fontsize=8)
    figure.savefig(path, dpi=DPI)


def _panel(axes: Axes, strategies: dict[str, Curve]) -> None:
    for strategy, curve in strategies.items():
        marker, color = STYLES[strategy]
        rates, values = [100 * rate for rate, _ in curve], [value for _, value in curve]
        axes.plot(rates, values, marker, ls="-", color=color, ms=4, lw=1, label=strategy)
    axes.grid(alpha=0.25, lw=0.5)
    axes.tick_params(labelsize=7)


def holding(curve: Curve, name: str) -> float:
    """The highest rate up to which nothing is more than `WORSE` worse than the curve's first."""
    first, last = curve[0][1], 0.0
    for rate, value in curve:
        if value < (1 - WORSE) * first if name == "chart" else value > (1 + WORSE) * first:
            break
        last = rate
    return last


def tables(found: Sequence[Record]) -> str:
    """Both as Markdown: how far each strategy holds, and the sizes."""
    return "\n".join([*_holding_table(found), "", *_size_table(found)])


def _holding_table(found: Sequence[Record]) -> Iterator[str]:
    yield "| up to 10 % worse than unpruned | strategy | chart accuracy | UV error |"
    yield "|---|---|---|---|"
    for title, strategies in curves(found).items():
        for strategy, networks in strategies.items():
            cells = (
                f"{holding(networks[name], name):.1%} (from {networks[name][0][1]:.4g})"
                for name in LABELS
            )
            yield f"| {title} | {strategy} | " + " | ".join(cells) + " |"


def _size_table(found: Sequence[Record]) -> Iterator[str]:
    yield "| kB | unpruned | COO | CSC | CSR | DIA |"
    yield "|---|---|---|---|---|---|"
    for name, published in SIZES.items():
        yield _size_row(f"{name}, {SIZED[name]:.1%} pruned, published (.npz)", published)
    for each in found:
        for name, rounds in each["rounds"].items():
            sized = {one["rate"]: one["bytes"] for one in rounds if "bytes" in one}
            if sized:
                sizes = sized[SIZED[name]] | {"dense": sized[0.0]["dense"]}
                title = f"{name}, {SIZED[name]:.1%} pruned, {each['asset']} (.nisp)"
                yield _size_row(title, {coding: size / 1e3 for coding, size in sizes.items()})


def _size_row(title: str, sizes: dict[str, float]) -> str:
    cells = (f"{sizes[coding]:.1f}" for coding in ("dense", "coo", "csc", "csr", "dia"))
    return f"| {title} | " + " | ".join(cells) + " |"
