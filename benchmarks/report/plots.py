"""Rate against distortion as pictures: every asset, every codec, its best settings as a line."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from benchmarks.codecs import CODECS
from benchmarks.rate_distortion.bjontegaard import front
from benchmarks.rate_distortion.rows import ERRORS, Row, curve, pairs

COLORS = {
    "obj": "#b0b0b0",
    "obj_xz": "#8c8c8c",
    "obj_zst": "#6b6b6b",
    "glb": "#c49a6c",
    "gltfpack": "#7b4fa3",
    "draco": "#2a7f3f",
    "simplified_draco": "#1f5fbf",
    "simplified_update_draco": "#4f9fe0",
    "simplified_update_meshopt": "#9b7fd0",
    "simplified_gltfpack": "#b08fc8",
    "nisp": "#d62f2f",
    "nisp_paper": "#e8953a",
}
# Errors of what keeps every bit, which a logarithm could not show.
LEAST_ERROR = 1e-5
COLUMNS, DPI = 4, 110
PANEL = (3.1, 2.6)


def draw(rows: Sequence[Row], path: Path, error: str) -> None:
    """All assets side by side, as PNG."""
    assets = sorted({row["asset"] for row in rows})
    lines = math.ceil(len(assets) / COLUMNS)
    columns = min(COLUMNS, len(assets))
    figure = Figure(figsize=(PANEL[0] * columns, PANEL[1] * lines + 0.5), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(lines, columns, squeeze=False, sharey=True).ravel()
    for axes in grid[len(assets) :]:
        axes.set_visible(False)
    for axes, asset in zip(grid, assets, strict=False):
        panel(axes, rows, asset, error)
    known: dict[str, Artist] = {}
    for axes in grid:
        handles, labels = axes.get_legend_handles_labels()
        known |= dict(zip(labels, handles, strict=True))
    figure.legend(
        known.values(), known, loc="outside upper center", ncols=len(CODECS), frameon=False
    )
    figure.savefig(path, dpi=DPI)


def panel(axes: Axes, rows: Sequence[Row], asset: str, error: str) -> None:
    """One asset: bytes without textures to the right, error upwards, both logarithmic."""
    for codec, name in CODECS.items():
        points = pairs(curve(rows, asset, codec, error), error)
        points = [(size, max(value, LEAST_ERROR)) for size, value in points]
        if not points:
            continue
        x, y = front(points).T
        marker, size, order = ("D", 5.0, 3) if codec == "nisp" else ("o", 2.5, 2)
        axes.plot(x, y, marker, ls="-", label=name, color=COLORS[codec], ms=size, zorder=order)
    axes.set_title(asset, fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda size, _: f"{size / 1e3:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(alpha=0.25, lw=0.5)
    axes.tick_params(labelsize=7)
    axes.set_xlabel("kB without textures", fontsize=7)
    axes.set_ylabel(ERRORS[error], fontsize=7)
