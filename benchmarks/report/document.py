"""Write measured tables and a plot into README.md and docs/benchmarks.md, from committed results.

    python -m benchmarks.report.document --bench build/bench

The tables are of what `benchmarks.headline.main_job`, `benchmarks.headline.duel`,
`benchmarks.studies.crossover`, `benchmarks.paper.rendered_views` and
`benchmarks.paper.synthesized_views` found. --bench keeps what `python -m benchmarks` left in that
folder as benchmarks/results/bench.{json,csv} and docs/rate_distortion.png: of these come the delta
rates and the sizes of the other codecs. Each table says at which commit its numbers were measured.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import click

from benchmarks.headline.duel import BETWEEN, DEMANDS, PRECISE
from benchmarks.headline.duel import RESULTS as DUEL
from benchmarks.headline.main_job import RESULTS
from benchmarks.measuring.result_file import Record, commits_of, read_result, write_result
from benchmarks.report import paper
from benchmarks.report.markdown import table
from benchmarks.studies.crossover import RESULTS as CROSSOVER
from nispcodec.core.atomic_write import write_atomic

DOCUMENT, README = Path("docs/benchmarks.md"), Path("README.md")
SHORT_BEGIN = "<!-- short table: python -m benchmarks.report.document -->\n"
SHORT_END = "<!-- end of short table -->\n"
SHORT_HEAD = ("asset", "OBJ", "`.nisp`", "simplify + Draco, as near", "distance", "encode")
BEGIN, END = "<!-- table: python -m benchmarks.report.document -->\n", "<!-- end of table -->\n"
HEAD = (
    "asset", "faces", "OBJ", "`.nisp`, no textures", "encode", "distance", "UV median", "charts",
    "color",
)  # fmt: skip
PEERS_BEGIN = "<!-- peers: python -m benchmarks.report.document -->\n"
PEERS_END = "<!-- end of peers -->\n"
PEERS_HEAD = (
    "kB, no textures", "`.nisp`", "simplify + Draco, as near", "and UVs as near",
    "between settings", "ours / theirs", "color, dB",
)  # fmt: skip
CURVES = {"distance": "delta rate, distance", "uv": "delta rate, UV"}
CROSSING_BEGIN = "<!-- crossover: python -m benchmarks.report.document -->\n"
CROSSING_END = "<!-- end of crossover -->\n"
CROSSING_HEAD = ("triangles", "`.nisp`", "distance", "simplify + Draco, as near", "Draco")
OTHERS = {
    "Draco 11/10 bits": ("draco", "11 10"),
    "gltfpack -cc 12/12 bits": ("gltfpack", "cc 12 12"),
    "OBJ.xz, 4 digits": ("obj_xz", "4 digits"),
}
BENCH, TABLE = Path("benchmarks/results/bench.json"), Path("benchmarks/results/bench.csv")
PLOT = Path("docs/rate_distortion.png")


def row(name: str, record: dict[str, Any]) -> list[str]:
    """One asset's cells."""
    metrics = record["metrics"]
    return [
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


def measured() -> str:
    """The table of `benchmarks.headline.main_job`."""
    results = read_result(RESULTS)
    rows = [row(name, record) for name, record in sorted(results["assets"].items())]
    machine = results["machine"]
    where = f"on {machine['cores']} cores, {machine['processor']}"
    return table(HEAD, rows) + f"\nMeasured at {commits(results)}, {where}.\n"


def shortened() -> str:
    """What the README shows of every asset."""
    results, duels = read_result(RESULTS), read_result(DUEL)["assets"]
    rows = []
    for name, record in sorted(results["assets"].items()):
        _, _, mesh, ours, seconds, distance, *_ = row(name, record)
        size = duels[name]["rival_bytes"]["distance and uv"]
        theirs = kilobytes(size) if size is None else f"{kilobytes(size)} kB"
        rows.append([name, mesh, ours, theirs, distance, seconds])
    return table(SHORT_HEAD, rows) + f"\nMeasured at {commits(results)}.\n"


def compared() -> str:
    """The table of the duel; delta rates and other codecs' sizes are from `benchmarks`."""
    found = read_result(DUEL)
    rates = read_result(BENCH)["summary"]["delta_rate"]
    with TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = [
        [
            *duel_cells(name, duel),
            *(percentage(rates.get(name, {}).get(error)) for error in CURVES),
            *(kilobytes(size_of(rows, name, title)) for title in OTHERS),
        ]
        for name, duel in sorted(found["assets"].items())
    ]
    head = [*PEERS_HEAD, *CURVES.values(), *OTHERS]
    when = f"Delta rates and all other codecs were measured at {commits(read_result(BENCH))}.\n"
    return table(head, lines) + means_line(found) + when


def crossing() -> str:
    """The table of `benchmarks.studies.crossover`."""
    results = read_result(CROSSOVER)
    lines = [
        [
            f"{level['faces']:,}",
            f"{kilobytes(level['nisp']['bytes'])} kB",
            f"{level['nisp']['distance']:.1e}",
            f"{kilobytes(level['simplified_draco']['same_distance_bytes'])} kB",
            f"{kilobytes(level['draco']['bytes'])} kB",
        ]
        for level in results["levels"]
    ]
    return table(CROSSING_HEAD, lines) + f"\nMeasured at {commits(results)}.\n"


def commits(results: Record) -> str:
    """The commits that a result's records name, each once, in words."""
    return "commit " + ", ".join(sorted(set(commits_of(results))))


def means_line(found: Record) -> str:
    """The means of our share, and of the colors."""
    means, color = found["means"][BETWEEN], found["color"]
    return (
        f"\nOurs / theirs in the geometric mean: {means['four']:.2f} over {', '.join(PRECISE)}; "
        f"{means['all']:.2f} over all that can be compared; the worst is {means['worst']:.2f}. "
        f"Color: {color['mean']:+.1f} dB in the mean, {color['worst']:+.1f} dB the worst. "
        f"{seeds_line(found['assets'].values())}\n"
    )


def seeds_line(duels: Iterable[dict[str, Any]]) -> str:
    """Of how many seeds the numbers are, and how far the share goes apart between them."""
    seeds = [duel["seeds"] for duel in duels]
    count = min(each["count"] for each in seeds)
    if count == 1:
        return "One seed."
    shares = {each["share"][1] / each["share"][0] for each in seeds if each["share"]}
    return (
        f"Means of {count} seeds; ours / theirs of the worst seed of an asset is up to "
        f"{max(shares) - 1:.0%} above that of its best."
    )


def duel_cells(name: str, duel: dict[str, Any]) -> list[str]:
    """One asset: sizes in kB, a dash where the rival is never as good."""
    sizes = [duel["bytes"], *(duel["rival_bytes"][demand] for demand in (*DEMANDS, BETWEEN))]
    share, color = duel["share"][BETWEEN], duel["color_above"]
    return [
        name,
        *map(kilobytes, sizes),
        "–" if share is None else f"{share:.2f}",
        "–" if color is None else f"{color:+.1f}",
    ]


def percentage(share: float | None) -> str:
    """A share more or less, a dash for none."""
    return "–" if share is None else f"{share:+.0%}"


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
    results = read_result(folder / "results.json")
    del results["points"]
    write_result(BENCH, results)
    write_atomic(TABLE, (folder / "results.csv").read_bytes())
    write_atomic(PLOT, (folder / "distance.png").read_bytes())


def replaced(text: str, begin: str, end: str, content: str) -> str:
    """The text with something else between two markers."""
    before, rest = text.split(begin)
    return before + begin + content + end + rest.split(end, 1)[1]


def written(text: str) -> str:
    """The document with its tables as the committed results have them."""
    text = replaced(text, BEGIN, END, measured())
    text = replaced(text, PEERS_BEGIN, PEERS_END, compared())
    text = replaced(text, paper.BEGIN, paper.END, paper.views())
    return replaced(text, CROSSING_BEGIN, CROSSING_END, crossing())


def introduced(text: str) -> str:
    """The README with its table as the committed results have it."""
    return replaced(text, SHORT_BEGIN, SHORT_END, shortened())


@click.command()
@click.option("--bench", type=click.Path(path_type=Path, exists=True), help="Keep these results.")
def main(bench: Path | None) -> None:
    """Replace what stands between the markers."""
    if bench is not None:
        keep(bench)
    write_atomic(DOCUMENT, written(DOCUMENT.read_text(encoding="utf-8")).encode())
    write_atomic(README, introduced(README.read_text(encoding="utf-8")).encode())


if __name__ == "__main__":
    main()
