"""The report: a summary, then for each asset its curves, pictures and table."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape

from benchmarks.codecs import CODECS
from benchmarks.measuring.result_file import Record
from benchmarks.rate_distortion.bjontegaard import front
from benchmarks.rate_distortion.rows import ERRORS, Row, curve, pairs, row
from benchmarks.rate_distortion.store import Store
from benchmarks.report.chart import Dot, Line, chart
from benchmarks.report.plots import COLORS, LEAST_ERROR
from benchmarks.report.tables import against, costs, points, table, textures

STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1200px;
  padding: 0 1em; color: #222 }
table { border-collapse: collapse; margin: .6em 0; font-variant-numeric: tabular-nums }
td, th { padding: .15em .7em; text-align: right; border-bottom: 1px solid #ddd;
  white-space: nowrap }
td:nth-child(-n+2), th:nth-child(-n+2) { text-align: left }
tr.problem td { color: #b00; white-space: normal }
svg { font: 10px system-ui, sans-serif; fill: #444; background: #fcfcfc; margin: 0 .5em .5em 0 }
svg .grid { stroke: #e4e4e4; fill: none } svg .line { fill: none; stroke-width: 1.5 }
svg circle { stroke: #fff; stroke-width: .6 } svg circle:hover { stroke: #000; stroke-width: 1.5 }
figure { display: inline-block; margin: 0 .6em .6em 0; width: 260px; vertical-align: top;
  font-size: 12px }
figure img { width: 100%; background: #fff; border: 1px solid #ddd }
.key span { margin-right: 1.2em; white-space: nowrap } .key i { display: inline-block; width: .9em;
height: .9em; border-radius: 50%; margin-right: .35em; vertical-align: -.1em }
details { margin: .5em 0 } summary { cursor: pointer }
"""


def page(results: Record, store: Store) -> str:
    """One HTML file that needs nothing else."""
    rows = [row(record) for record in results["points"]]
    assets = sorted({each["asset"] for each in rows})
    body = [head(results, assets), summary(results), costs(results["summary"]["costs"])]
    body += [section(asset, rows, results, store) for asset in assets]
    title = "nispcodec: rate against distortion"
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title>'
        f"<style>{STYLE}</style><h1>{title}</h1>{''.join(body)}</html>\n"
    )


def head(results: Record, assets: Sequence[str]) -> str:
    """Where and with what it was measured, and the key of the colors."""
    machine, versions = results["machine"], results["versions"]
    where = f"{machine['processor']}, {machine['cores']} cores, {machine['system']}"
    libraries = ", ".join(f"{name} {version}" for name, version in versions.items())
    commits = sorted({record.get("commit") for record in results["points"]} - {None})
    key = "".join(
        f'<span><i style="background:{COLORS[codec]}"></i>{escape(name)}</span>'
        for codec, name in CODECS.items()
    )
    links = " · ".join(f'<a href="#{escape(name)}">{escape(name)}</a>' for name in assets)
    return (
        f"<p>{escape(where)}; {escape(libraries)}; commit {escape(', '.join(commits))}; "
        f"seeds {results['seeds']}, {results['samples']:,} samples each way.</p>"
        "<p>Distances are in the normalized frame (bounding-box center at 0, farthest vertex at "
        "radius 1), the larger of both directions; of the original only what can be seen from "
        "outside counts. Bytes are those of the file, without textures.</p>"
        f'<p class="key">{key}</p><p>{links}</p>'
    )


def summary(results: Record) -> str:
    """The Bjontegaard-delta rates, by asset and in the mean."""
    found = results["summary"]
    lines = [*found["delta_rate"].items(), ("mean", found["mean_delta_rate"])]
    cells = [
        [name, "", *("–" if rate[error] is None else f"{rate[error]:+.0%}" for error in ERRORS)]
        for name, rate in lines
    ]
    return (
        "<h2>.nisp against simplify + Draco: Bjontegaard-delta rate</h2>"
        "<p>Bytes more (+) or less (−) at equal error; – where a curve has fewer than five points "
        "that are worth their bytes, or the curves share no range.</p>"
        + table(["asset", "", *ERRORS.values()], cells)
    )


def section(asset: str, rows: Sequence[Row], results: Record, store: Store) -> str:
    """Everything about one asset."""
    alike = [record for record in results["points"] if record["asset"] == asset]
    images = [record for record in results["textures"] if record["asset"] == asset]
    mine = [each for each in rows if each["asset"] == asset]
    charts = [_chart(mine, asset, error) for error in ERRORS]
    return (
        f'<h2 id="{escape(asset)}">{escape(asset)}</h2>{"".join(charts)}'
        f"{_pictures(asset, alike, store)}"
        f"{against(results['summary']['against_rival'][asset])}{textures(images, mine)}"
        f"<details><summary>All {len(mine)} points</summary>{points(mine)}</details>"
    )


def _chart(rows: Sequence[Row], asset: str, error: str) -> str:
    dots, lines = [], []
    for codec, name in CODECS.items():
        found = curve(rows, asset, codec, error)
        places = [(size, max(value, LEAST_ERROR)) for size, value in pairs(found, error)]
        dots += [
            Dot(x, y, COLORS[codec], _hover(name, each), codec == "nisp")
            for (x, y), each in zip(places, found, strict=True)
        ]
        best = front(places)
        if len(best) > 1:
            lines.append(Line([(float(x), float(y)) for x, y in best], COLORS[codec]))
    return chart(dots, lines, "bytes without textures", ERRORS[error]) if dots else ""


def _hover(name: str, point: Row) -> str:
    lines = [f"{name} {point['setting']}", f"{point['bytes']:,} bytes, {point['faces']:,} faces"]
    lines += [f"{what}: {point[error]:.2e}" for error, what in ERRORS.items() if point[error]]
    return "\n".join(lines)


def _pictures(asset: str, records: Sequence[Record], store: Store) -> str:
    shown = [_figure(store.original(asset), "original")]
    drawn = [record for record in records if "psnr" in record.get("pictures", {})]
    for record in sorted(drawn, key=lambda each: (each["codec"] != "nisp", each["bytes"])):
        found = row(record)
        shown.append(
            _figure(
                store.picture(record),
                f"{CODECS[record['codec']]} {found['setting']}: {record['bytes']:,} bytes, "
                f"{found['picture_psnr']:.1f} dB, SSIM {found['picture_ssim']:.3f}",
            )
        )
    return f"<details open><summary>Pictures</summary>{''.join(shown)}</details>"


def _figure(picture: bytes | None, caption: str) -> str:
    if picture is None:
        return ""
    data = base64.b64encode(picture).decode()
    image = f'<img loading="lazy" alt="" src="data:image/webp;base64,{data}">'
    return f"<figure>{image}<figcaption>{escape(caption)}</figcaption></figure>"
