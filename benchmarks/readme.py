"""Write the measured tables and the plot into the README, from results that are committed.

    python -m benchmarks.readme --bench build/bench

The tables are of what `benchmarks.main_job` and `benchmarks.duel` found. --bench keeps what
`python -m benchmarks` left in that folder as benchmarks/results/bench.{json,csv} and
docs/rate_distortion.png: of these come the sizes of the other codecs.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from benchmarks.duel import PRECISE
from benchmarks.duel import RESULTS as DUEL
from benchmarks.main_job import RESULTS
from nispcodec.output import write_atomic

README = Path("README.md")
BEGIN, END = "<!-- table: python -m benchmarks.readme -->\n", "<!-- end of table -->\n"
HEAD = (
    "| asset | faces | OBJ | `.nisp`, no textures | encode "
    "| distance | UV median | charts | colour |\n"
    "|---|---|---|---|---|---|---|---|---|\n"
)
PEERS_BEGIN = "<!-- peers: python -m benchmarks.readme -->\n"
PEERS_END = "<!-- end of peers -->\n"
PEERS_HEAD = (
    "kB, no textures", "`.nisp`", "simplify + Draco, as near", "and UVs as near", "ours / theirs",
)  # fmt: skip
OTHERS = {
    "Draco 11/10 bits": ("draco", "11 10"),
    "gltfpack -cc 12/12 bits": ("gltfpack", "cc 12 12"),
    "OBJ.xz, 4 digits": ("obj_xz", "4 digits"),
}
BENCH, TABLE = Path("benchmarks/results/bench.json"), Path("benchmarks/results/bench.csv")
PLOT = Path("docs/rate_distortion.png")


def row(name: str, record: dict[str, Any]) -> str:
    """One asset's line."""
    metrics = record["metrics"]
    texts = [
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
    return cells(texts)


def measured() -> str:
    """The table of `benchmarks.main_job`."""
    results = json.loads(Path(RESULTS).read_text(encoding="utf-8"))
    rows = [row(name, record) for name, record in sorted(results["assets"].items())]
    machine = results["machine"]
    where = f"\nMeasured on {machine['cores']} cores, {machine['processor']}.\n"
    return HEAD + "".join(rows) + where


def compared() -> str:
    """The table of `benchmarks.duel`, and the sizes of other codecs that have been measured."""
    found = json.loads(DUEL.read_text(encoding="utf-8"))
    rows: list[dict[str, str]] = []
    if TABLE.exists():
        with TABLE.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    duels = sorted(found["assets"].items())
    others = [title for title in OTHERS if any(size_of(rows, name, title) for name, _ in duels)]
    lines = [cells(PEERS_HEAD + tuple(others)), cells(["---"] * (len(PEERS_HEAD) + len(others)))]
    lines += [
        cells([*duel_cells(name, duel), *(kilobytes(size_of(rows, name, each)) for each in others)])
        for name, duel in duels
    ]
    return "".join(lines) + means_line(found["means"]["distance and uv"])


def means_line(means: dict[str, float]) -> str:
    """The geometric means of our share."""
    return (
        f"\nOurs / theirs in the geometric mean: {means['four']:.2f} over "
        f"{', '.join(PRECISE)}; {means['all']:.2f} over all.\n"
    )


def duel_cells(name: str, duel: dict[str, Any]) -> list[str]:
    """One asset: sizes in kB, a dash where the rival is never as good."""
    rival, share = duel["rival_bytes"], duel["share"]["distance and uv"]
    sizes = [duel["bytes"], rival["distance"], rival["distance and uv"]]
    return [name, *map(kilobytes, sizes), "–" if share is None else f"{share:.2f}"]


def cells(texts: Iterable[str]) -> str:
    """A line of a table."""
    return "| " + " | ".join(texts) + " |\n"


def kilobytes(size: int | None) -> str:
    """A size to a hundred bytes."""
    return "–" if size is None else f"{size / 1e3:,.1f}"


def size_of(rows: list[dict[str, str]], asset: str, title: str) -> int | None:
    """Bytes of one measured point of `OTHERS`."""
    codec, setting = OTHERS[title]
    wanted = {"asset": asset, "codec": codec, "setting": setting}
    found = [row for row in rows if wanted.items() <= row.items() and row["bytes"]]
    return int(found[0]["bytes"]) if found else None


def keep(folder: Path) -> None:
    """Copy what a run left to where it is committed; the points' details stay behind."""
    results = json.loads((folder / "results.json").read_text(encoding="utf-8"))
    del results["points"]
    write_atomic(BENCH, json.dumps(results, indent=1).encode() + b"\n")
    write_atomic(TABLE, (folder / "results.csv").read_bytes())
    write_atomic(PLOT, (folder / "distance.png").read_bytes())


def replaced(text: str, begin: str, end: str, content: str) -> str:
    """The text with something else between two markers."""
    before, rest = text.split(begin)
    return before + begin + content + end + rest.split(end, 1)[1]


@click.command()
@click.option("--bench", type=click.Path(path_type=Path, exists=True), help="Keep these results.")
def main(bench: Path | None) -> None:
    """Replace what stands between the markers."""
    if bench is not None:
        keep(bench)
    text = README.read_text(encoding="utf-8")
    text = replaced(text, BEGIN, END, measured())
    text = replaced(text, PEERS_BEGIN, PEERS_END, compared())
    write_atomic(README, text.encode())


if __name__ == "__main__":
    main()
