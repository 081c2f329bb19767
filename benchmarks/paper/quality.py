"""From what the main job measured of every asset: training time, parameterization, pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from benchmarks.measuring.result_file import Record
from benchmarks.paper.row import Comparison

DISTORTION = {
    "mean, original": ("original", "mean", 3.58),
    "mean, learned": ("decoded", "mean", 9.60),
    "maximum, learned": ("decoded", "max", 9.96e3),
    "standard deviation, learned": ("decoded", "std", 60.13),
}
# Share of an asset's own triangles without area in UV, as colors of a palette have: above it the
# metric says nothing.
PALETTE = 0.05
ASSETS = "published: mean over the paper's own assets; ours: the default preset, over {assets}"


def quality(main_job: Record) -> Iterator[Comparison]:
    """Means over the assets of the main job."""
    assets: dict[str, Record] = main_job["assets"]
    differs = ASSETS.format(assets=", ".join(sorted(assets)))
    records = list(assets.values())
    yield from training(records, differs)
    yield from distortion(assets)
    yield from pictures(assets)


def training(records: Sequence[Record], differs: str) -> Iterator[Comparison]:
    """How long, and to which held-out errors; the latter of what has networks."""
    machine = f"published: RTX 2070 SUPER, Mario; ours: 2 cores, the whole encode; {differs}"
    table = "Training (section 4)"
    hours = np.mean([record["encode"]["seconds"] for record in records]) / 3600
    yield Comparison(table, "all networks", 1.65, float(hours), "h", machine)
    infos = [record["report"]["measured"] for record in records]
    for name, published, unit in (("chart_accuracy", 0.989, ""), ("uv_error_mean", 3e-4, "")):
        known = [float(info[name]) for info in infos if name in info]
        what = name.replace("_", " ")
        if known:
            yield Comparison(table, what, published, float(np.mean(known)), unit, machine)


def distortion(assets: dict[str, Record]) -> Iterator[Comparison]:
    """max(sigma_max, 1 / sigma_min) over triangles (table 1), of assets that are no `PALETTE`."""
    sides = {
        name: record["metrics"]["parameterization"]
        for name, record in sorted(assets.items())
        if record["metrics"]["parameterization"]["original"]["collapsed"] <= PALETTE
    }
    differs = ASSETS.format(assets=", ".join(sides))
    for what, (side, statistic, published) in DISTORTION.items():
        values = [each[side][statistic] for each in sides.values()]
        yield Comparison(
            "Distortion of the parameterization (table 1)",
            what,
            published,
            float(np.mean(values)),
            "",
            differs,
        )


def pictures(assets: dict[str, Record]) -> Iterator[Comparison]:
    """Rendered views against the original's (table 3)."""
    drawn = {
        name: record["metrics"]["pictures"]
        for name, record in sorted(assets.items())
        if "pictures" in record["metrics"]
    }
    if not drawn:
        return
    differs = ASSETS.format(assets=", ".join(drawn))
    table, ours = "Rendered views (table 3), lit", f"ours: of the decoded mesh, lit; {differs}"
    for name, published, unit in (("psnr", 43.85, "dB"), ("ssim", 0.996, "")):
        mean = float(np.mean([each[name] for each in drawn.values()]))
        yield Comparison(table, name.upper(), published, mean, unit, ours)
