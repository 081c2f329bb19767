"""The report's tables."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from benchmarks.codecs import CODECS
from benchmarks.measuring.result_file import Record
from benchmarks.rate_distortion.rows import Row

COLUMNS = {
    "bytes": ",.0f",
    "faces": ",.0f",
    "distance": ".2e",
    "distance_p99": ".2e",
    "d1_psnr": ".1f",
    "d2_psnr": ".1f",
    "normal_consistency": ".3f",
    "uv": ".2e",
    "uv_median": ".2e",
    "color_psnr": ".1f",
    "picture_psnr": ".1f",
    "picture_ssim": ".3f",
    "encode_seconds": ".2f",
    "decode_seconds": ".2f",
}
MEBI = 2**20


def table(head: Sequence[str], rows: Sequence[Sequence[str]], classes: Sequence[str] = ()) -> str:
    """An HTML table of plain text cells; `classes` are of the rows."""
    names = [*classes, *([""] * (len(rows) - len(classes)))]
    lines = [
        f'<tr class="{name}">{"".join(f"<td>{escape(cell)}</td>" for cell in cells)}</tr>'
        for name, cells in zip(names, rows, strict=True)
    ]
    first = "".join(f"<th>{escape(name)}</th>" for name in head)
    return f"<table><tr>{first}</tr>{''.join(lines)}</table>"


def points(rows: Sequence[Row]) -> str:
    """Every point of one asset; what failed or was skipped says why."""
    order = list(CODECS)
    ordered = sorted(rows, key=lambda each: (order.index(each["codec"]), each["bytes"] or 0))
    cells = [[CODECS[each["codec"]], each["setting"], *_numbers(each)] for each in ordered]
    classes = ["problem" if each["problem"] else "" for each in ordered]
    return table(
        ["codec", "setting", *(name.replace("_", " ") for name in COLUMNS)], cells, classes
    )


def against(duels: Sequence[dict[str, Any]]) -> str:
    """Our points, and with how many bytes simplify + Draco is as good."""
    if not duels:
        return ""
    demands = list(duels[0]["rival_bytes"])
    cells = [
        [".nisp", duel["setting"], f"{duel['bytes']:,}", *map(_count, duel["rival_bytes"].values())]
        for duel in duels
    ]
    head = ["", "setting", "bytes", *(f"same {name.replace('_', ' ')}" for name in demands)]
    return f"<p>Bytes with which simplify + Draco is as good:</p>{table(head, cells)}"


def textures(images: Sequence[Record], rows: Sequence[Row]) -> str:
    """The texture codecs, and the smallest .nisp and Draco files with each of them."""
    sizes = {
        codec: [row["bytes"] for row in rows if row["codec"] == codec and row["bytes"]]
        for codec in ("nisp", "draco")
    }
    cells = []
    for record in (each for each in images if "bytes" in each):
        label = " ".join(map(str, record["setting"].values()))
        totals = [_count(min(s) + record["bytes"] if s else None) for s in sizes.values()]
        seconds = f"{record['encode']['seconds']:.1f}"
        psnr = f"{record['psnr']:.1f}"
        cells.append(["textures", label, f"{record['bytes']:,}", psnr, seconds, *totals])
    head = ["", "format", "bytes", "PSNR dB", "encode s", "smallest .nisp with it", "Draco with it"]
    return table(head, cells) if cells else ""


def costs(found: dict[str, dict[str, float | None]]) -> str:
    """Median time and memory of each codec."""
    cells = [
        [
            CODECS[codec],
            "",
            _number(cost["encode_seconds"], ".2f"),
            _number(cost["encode_peak_bytes"], ",.0f", MEBI),
            _number(cost["decode_seconds"], ".2f"),
            _number(cost["decode_peak_bytes"], ",.0f", MEBI),
        ]
        for codec, cost in found.items()
    ]
    head = ["codec", "", "encode s", "encode MiB", "decode s", "decode MiB"]
    return (
        "<h2>Time and memory, medians over all points</h2>"
        "<p>In a process of its own; memory is what came on top of the loaded input.</p>"
        + table(head, cells)
    )


def _numbers(row: Row) -> list[str]:
    if row["problem"]:
        return [row["problem"], *([""] * (len(COLUMNS) - 1))]
    return [_number(row[name], pattern) for name, pattern in COLUMNS.items()]


def _number(value: float | None, pattern: str, unit: float = 1) -> str:
    return "" if value is None else format(value / unit, pattern)


def _count(value: int | None) -> str:
    return "none" if value is None else f"{value:,}"
