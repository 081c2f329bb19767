"""The paper's table 3 for docs/benchmarks.md: views by SRN, NeRF and ours, and by every preset."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from benchmarks.measuring.result_file import Record, commits_of, read_result
from benchmarks.paper.published import VIEWS as PUBLISHED
from benchmarks.paper.rendered_views import RESULTS as RENDERED
from benchmarks.paper.rendered_views import means
from benchmarks.paper.synthesized_views import OURS, SYSTEMS
from benchmarks.paper.synthesized_views import RESULTS as SYNTHESIZED
from benchmarks.report.markdown import table

BEGIN = "<!-- paper's views: python -m benchmarks.report.document -->\n"
END = "<!-- end of paper's views -->\n"
HEAD = ("system", "MSE", "PSNR", "SSIM", "bytes", "trained")
NETWORKS = "networks"
TRAINED = {"SRN": "8 h, one GPU", "NeRF": "4 h, one GPU", OURS: "1.7 h, one GPU"}


def views() -> str:
    """Both tables, and what they are of."""
    synthesized, rendered = read_result(SYNTHESIZED), read_result(RENDERED)
    assets, presets = synthesized["assets"], rendered["presets"]
    first = table(HEAD, [row for system in (*SYSTEMS, OURS) for row in _rows(system, assets)])
    second = table(_preset_head(presets), _preset_rows(presets))
    when = ", ".join(sorted(set(commits_of([synthesized, rendered]))))
    return f"{first}\nOurs are means over {', '.join(assets)}.\n\n{second}\nMeasured at {when}.\n"


def _rows(system: str, assets: dict[str, Record]) -> Iterable[Sequence[str]]:
    yield [f"{system}, published", *_likeness(PUBLISHED[system]), "–", TRAINED[system]]
    records = [record[system] for record in assets.values() if system in record]
    if not records:
        return
    size = float(np.mean([each["bytes"] for each in records])) / 1e3
    if system == OURS:
        own = float(np.mean([each["geometry_uv"] for each in records])) / 1e3
        size_told, trained = f"{size:,.0f} kB, {own:.1f} without textures", "`balanced`"
    else:
        minutes = float(np.mean([each["processor_seconds"] for each in records])) / 60
        size_told, trained = f"{size:,.0f} kB", f"{minutes:.1f} min, one core"
    name = "`.nisp`" if system == OURS else f"{system}, small"
    likeness = [each["views"] for each in records]
    mean = {key: float(np.mean([each[key] for each in likeness])) for key in likeness[0]}
    yield [name, *_likeness(mean), size_told, trained]


def _likeness(numbers: Record) -> tuple[str, str, str]:
    return f"{numbers['mse']:.2f}", f"{numbers['psnr']:.2f} dB", f"{numbers['ssim']:.3f}"


def _preset_head(presets: dict[str, dict[str, Record]]) -> Sequence[str]:
    return ["unlit PSNR, kB without textures", *(f"`{preset}`" for preset in presets)]


def _preset_rows(presets: dict[str, dict[str, Record]]) -> Iterable[Sequence[str]]:
    names = sorted({name for assets in presets.values() for name in assets})
    for name in names:
        yield [
            name,
            *(_cell([assets[name]] if name in assets else []) for assets in presets.values()),
        ]
    common = [name for name in names if all(name in assets for assets in presets.values())]
    if len(common) > 1:
        cells = (_cell([assets[name] for name in common]) for assets in presets.values())
        yield [f"mean of {', '.join(common)}", *cells]


def _cell(records: Sequence[Record]) -> str:
    """Means of likeness and bytes; a dash for none."""
    if not records:
        return "–"
    size = float(np.mean([each["bytes"]["geometry_uv"] for each in records])) / 1e3
    unlit = means(records)["unlit"]
    held = "".join(f" of {each['held_as']}" for each in records if each["held_as"] != NETWORKS)
    return f"{unlit['psnr']:.1f} dB, {size:.1f} kB{held if len(records) == 1 else ''}"
