"""Write the measured table into the README, from the committed results.

python -m benchmarks.readme
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from benchmarks.main_job import RESULTS
from nispcodec.output import write_atomic

README = Path("README.md")
BEGIN, END = "<!-- table: python -m benchmarks.readme -->\n", "<!-- end of table -->\n"
HEAD = (
    "| asset | faces | OBJ | `.nisp`, no textures | encode "
    "| distance | UV median | charts | colour |\n"
    "|---|---|---|---|---|---|---|---|---|\n"
)


def row(name: str, record: dict[str, Any]) -> str:
    """One asset's line."""
    metrics = record["metrics"]
    cells = [
        name,
        f"{record['faces']:,}",
        f"{record['report']['input_bytes']['mesh'] / 1e3:,.0f} kB",
        f"{record['bytes']['geometry_uv'] / 1e3:.1f} kB",
        f"{record['encode']['seconds']:.0f} s",
        f"{metrics['geometry']['larger']['mean']:.1e}",
        f"{metrics['uv']['larger']['median']:.1e}",
        f"{metrics['charts']['accuracy']:.3f}",
        f"{metrics['color']['psnr']:.1f} dB",
    ]
    return "| " + " | ".join(cells) + " |\n"


def main() -> None:
    """Replace what stands between the markers."""
    results = json.loads(Path(RESULTS).read_text(encoding="utf-8"))
    rows = [row(name, record) for name, record in sorted(results["assets"].items())]
    where = (
        f"\nMeasured on {results['machine']['cores']} cores, {results['machine']['processor']}.\n"
    )
    text = README.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    write_atomic(README, (before + BEGIN + HEAD + "".join(rows) + where + END + after).encode())


if __name__ == "__main__":
    main()
