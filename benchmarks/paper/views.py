"""Table 3 from committed results: views by every preset of ours, by SRN and by NeRF."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.measuring.result_file import Record, read_result
from benchmarks.paper.published import VIEWS as PUBLISHED
from benchmarks.paper.rendered_views import RESULTS as RENDERED
from benchmarks.paper.rendered_views import means
from benchmarks.paper.row import Comparison
from benchmarks.paper.synthesized_views import RESULTS as SYNTHESIZED
from benchmarks.paper.synthesized_views import SYSTEMS

UNITS = {"mse": "", "psnr": "dB", "ssim": ""}
SMALL = "ours: small, under a minute of one core, 128 pixels, unlit"
TABLE = "Views (table 3)"


def views() -> Iterator[Comparison]:
    """Each number of each system, and of each preset."""
    rendered, synthesized = read_result(RENDERED), read_result(SYNTHESIZED)
    for preset, assets in rendered["presets"].items():
        yield from _rows("ours", f"{TABLE}: `{preset}`", means(assets.values())["unlit"], assets)
    for system in SYSTEMS:
        found = {
            name: record[system]["views"]
            for name, record in synthesized["assets"].items()
            if system in record
        }
        if found:
            mean = {name: float(np.mean([each[name] for each in found.values()])) for name in UNITS}
            yield from _rows(system, f"{TABLE}: {system}", mean, found)


def _rows(system: str, table: str, numbers: Record, assets: dict[str, Any]) -> Iterator[Comparison]:
    trained = {
        "ours": "ours: unlit, 512 pixels",
        "SRN": f"published: 8 h on an RTX 2070 SUPER; {SMALL}",
        "NeRF": f"published: 4 h on an RTX 2070 SUPER; {SMALL}",
    }
    differs = f"published: three of the paper's own assets; {trained[system]}, {', '.join(assets)}"
    for name, unit in UNITS.items():
        published = PUBLISHED[system][name]
        yield Comparison(table, name.upper(), published, numbers[name], unit, differs)
