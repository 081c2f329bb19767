"""From the points that the main benchmark measured: training time, parameterization, pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from benchmarks.measuring.result_file import Record
from benchmarks.paper.row import Comparison
from benchmarks.rate_distortion.store import Store
from nispcodec.format import unpack

PRESET = {"preset": "balanced"}
DISTORTION = {
    "mean, original": ("original", "mean", 3.58),
    "mean, learned": ("decoded", "mean", 9.60),
    "maximum, learned": ("decoded", "max", 9.96e3),
    "standard deviation, learned": ("decoded", "std", 60.13),
}
ASSETS = "published: mean over the paper's own assets; ours: over {assets}"


def quality(store: Store) -> Iterator[Comparison]:
    """Means over the assets that were measured with the default preset; none without any."""
    records = [r for r in store.records() if r["codec"] == "nisp" and r["setting"] == PRESET]
    records = [record for record in records if "metrics" in record]
    if records:
        differs = ASSETS.format(assets=", ".join(record["asset"] for record in records))
        yield from training(store, records, differs)
        yield from distortion(records, differs)
        yield from pictures(records, differs)


def training(store: Store, records: Sequence[Record], differs: str) -> Iterator[Comparison]:
    """How long, and to which held-out errors."""
    machine = f"published: RTX 2070 SUPER, Mario; ours: 2 cores; {differs}"
    table = "Training (section 4)"
    hours = np.mean([record["encode"]["seconds"] for record in records]) / 3600
    yield Comparison(table, "all networks", 1.65, float(hours), "h", machine)
    infos = [unpack(store.file(record)).info for record in records]
    for name, published, unit in (("chart_accuracy", 0.989, ""), ("uv_error_mean", 3e-4, "")):
        known = [float(info[name]) for info in infos if name in info]
        what = name.replace("_", " ")
        if known:
            yield Comparison(table, what, published, float(np.mean(known)), unit, machine)


def distortion(records: Sequence[Record], differs: str) -> Iterator[Comparison]:
    """max(sigma_max, 1 / sigma_min) over triangles (table 1)."""
    for what, (side, statistic, published) in DISTORTION.items():
        values = [record["metrics"]["parameterization"][side][statistic] for record in records]
        yield Comparison(
            "Distortion of the parameterization (table 1)",
            what,
            published,
            float(np.mean(values)),
            "",
            differs,
        )


def pictures(records: Sequence[Record], differs: str) -> Iterator[Comparison]:
    """Rendered views against the original's (table 3)."""
    drawn = [record["pictures"] for record in records if "psnr" in record.get("pictures", {})]
    if not drawn:
        return
    table, ours = "Rendered views (table 3)", f"ours: of the decoded mesh; {differs}"
    for name, published, unit in (("psnr", 43.85, "dB"), ("ssim", 0.996, "")):
        mean = float(np.mean([each[name] for each in drawn]))
        yield Comparison(table, name.upper(), published, mean, unit, ours)
