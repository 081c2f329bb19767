"""The page of a catalogue, `catalogue.html`: one file that needs nothing else to be looked at."""

from __future__ import annotations

import base64
import os
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from string import Template
from urllib.parse import quote

from nispcodec.catalogue.histogram import histogram
from nispcodec.catalogue.record import Record
from nispcodec.catalogue.storage import Storage, joined, storage_of
from nispcodec.catalogue.thumbnails import DECODED, ORIGINAL
from nispcodec.catalogue.work import thumbnail_of

PAGE = "catalogue.html"
PICTURED = 2000
"""Assets whose pictures are in the page: 2 to 8 kB each. Of the others the numbers are."""

COLUMNS: Sequence[tuple[str, str, str]] = (
    ("input, bytes", "bytes", "input"),
    (".nisp, bytes", "bytes", "total"),
    ("without textures", "bytes", "geometry_uv"),
    ("distance", "errors", "distance_error"),
    ("median UV", "errors", "uv_error_median"),
    ("charts", "errors", "chart_accuracy"),
    ("encode, s", "seconds", "encode"),
)
"""Heading, member of a record, name in it."""

TEMPLATE = Template("""<!doctype html>
<html lang="en"><meta charset="utf-8"><title>$title</title>
<meta name="viewport" content="width=device-width">
<style>
body { font: 14px system-ui, sans-serif; margin: 2em; color: #222 }
table { border-collapse: collapse } th, td { padding: .3em .7em; border-bottom: 1px solid #ddd }
th { cursor: pointer; text-align: left; position: sticky; top: 0; background: #fff }
td.n { text-align: right; font-variant-numeric: tabular-nums } tr.failed { background: #fee }
figure { display: inline-block; margin: 0 2em 1em 0 } rect { fill: #47a } text { font-size: 11px }
</style>
<h1>$title</h1><p>$summary</p>$plots
<table><thead><tr>$head</tr></thead><tbody>
""")

FOOT = """</tbody></table>
<script>
document.querySelectorAll("th").forEach((head, column) => head.onclick = () => {
  const body = document.querySelector("tbody"), way = head.dataset.way = -(head.dataset.way || -1)
  const value = row => row.cells[column].dataset.v ?? row.cells[column].textContent
  const order = (a, b) => a !== "" && b !== "" && isFinite(a) && isFinite(b)
    ? a - b : a.localeCompare(b)
  body.append(...[...body.rows].sort((a, b) => way * order(value(a), value(b))))
})
</script></html>
"""


def write_page(folder: str, records: Mapping[str, Record], viewer: str = "") -> None:
    """Write the page beside the ledger: failures first, then by output.

    viewer: URL of a page that shows a `.nisp`, whose place comes after `?file=`; "" for none.
    Raises OSError or NispError where it cannot be written.
    """
    storage = storage_of(folder)
    ordered = sorted(records.values(), key=lambda each: (each.done, each.output, each.source))
    text = "".join(_parts(storage, folder, ordered, viewer))
    storage.write(joined(folder, PAGE), text.encode("utf-8", "backslashreplace"))


def _parts(storage: Storage, folder: str, records: Sequence[Record], viewer: str) -> Iterator[str]:
    headings = ["asset", "original", "decoded", *(heading for heading, _, _ in COLUMNS), "said"]
    yield TEMPLATE.substitute(
        title="Catalogue",
        summary=_summary(records),
        plots=_plots(records),
        head="".join(f"<th>{escape(each)}</th>" for each in headings),
    )
    for number, record in enumerate(records):
        pictured = record.done and number < PICTURED
        yield _row(record, viewer, _pictures(storage, folder, record) if pictured else {})
    yield FOOT


def _summary(records: Sequence[Record]) -> str:
    done = [each for each in records if each.done]
    after = sum(each.bytes.get("total", 0) for each in done)
    before = after + sum(each.saved for each in done)
    without = f"; pictures of the first {PICTURED:,}" if len(records) > PICTURED else ""
    return (
        f"{len(done):,} assets, {len(records) - len(done):,} failures; "
        f"{after:,} bytes from {before:,}{without}. Distances are shares of an asset's radius."
    )


def _plots(records: Sequence[Record]) -> str:
    done = [each for each in records if each.done]
    kinds = (
        (".nisp without textures", "bytes", "bytes", "geometry_uv"),
        (".nisp", "bytes", "bytes", "total"),
        ("mean distance", "radii", "errors", "distance_error"),
        ("median UV error", "", "errors", "uv_error_median"),
    )
    return "".join(
        histogram(title, [_value(each, member, name) or 0 for each in done], unit)
        for title, unit, member, name in kinds
    )


def _row(record: Record, viewer: str, pictures: Mapping[str, str]) -> str:
    cells = [f"<td>{_name(record, viewer)}</td>"]
    for name in (ORIGINAL, DECODED):
        cells.append(f'<td data-v="">{pictures.get(name, "")}</td>')
    cells += [_number(_value(record, member, name)) for _, member, name in COLUMNS]
    said = [record.error] if record.error else list(record.warnings)
    cells.append(f"<td>{escape('; '.join(said))}</td>")
    return f'<tr class="{"done" if record.done else "failed"}">{"".join(cells)}</tr>\n'


def _name(record: Record, viewer: str) -> str:
    shown = escape(record.output or record.source)
    if not record.done:
        return shown
    place = quote(os.fsencode(record.output))
    link = f'<a href="{place}">{shown}</a>'
    if viewer:
        link += f' <a href="{escape(viewer)}?file={quote(place, safe="")}">view</a>'
    return link


def _value(record: Record, member: str, name: str) -> float | None:
    if name == "input":
        known = record.bytes
        return known["input_mesh"] + known["input_textures"] if "input_mesh" in known else None
    found: float | None = getattr(record, member).get(name)
    return found


def _number(value: float | None) -> str:
    if value is None:
        return '<td data-v=""></td>'
    shown = f"{value:,}" if isinstance(value, int) else f"{value:.3g}"
    return f'<td class="n" data-v="{value}">{shown}</td>'


def _pictures(storage: Storage, folder: str, record: Record) -> dict[str, str]:
    """The pictures that are there, as elements of the page."""
    found = {}
    for name in (ORIGINAL, DECODED):
        try:
            data = storage.read(joined(folder, thumbnail_of(record.output, name)))
        except OSError:
            continue
        text = base64.b64encode(data).decode()
        found[name] = f'<img alt="{name}" loading="lazy" src="data:image/webp;base64,{text}">'
    return found
