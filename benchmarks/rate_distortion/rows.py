"""Measured points as flat rows of numbers, for tables, curves and CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from typing import Any

from benchmarks.measuring.result_file import Record

Row = dict[str, Any]

# The errors that curves are drawn of, and what they are called.
ERRORS = {
    "distance": "mean distance",
    "uv": "mean UV error",
    "uv_median": "median UV error",
    "color": "RMS color error",
}
PLACES = {
    "distance": ("metrics", "geometry", "larger", "mean"),
    "distance_p99": ("metrics", "geometry", "larger", "p99"),
    "distance_max": ("metrics", "geometry", "larger", "max"),
    "d1_psnr": ("metrics", "geometry", "d1_psnr"),
    "d2_psnr": ("metrics", "geometry", "d2_psnr"),
    "normal_consistency": ("metrics", "geometry", "normal_consistency"),
    "spurious": ("metrics", "spurious", "count"),
    "uv": ("metrics", "uv", "larger", "mean"),
    "uv_median": ("metrics", "uv", "larger", "median"),
    "uv_p99": ("metrics", "uv", "larger", "p99"),
    "color_psnr": ("metrics", "color", "psnr"),
    "picture_psnr": ("pictures", "psnr"),
    "picture_ssim": ("pictures", "ssim"),
    "encode_seconds": ("encode", "seconds"),
    "encode_cpu_seconds": ("encode", "cpu_seconds"),
    "encode_peak_bytes": ("encode", "peak_bytes"),
    "decode_seconds": ("decode", "seconds"),
    "decode_cpu_seconds": ("decode", "cpu_seconds"),
    "decode_peak_bytes": ("decode", "peak_bytes"),
}
NAMES = ("asset", "codec", "setting", "bytes", "faces", *PLACES, "color", "problem", "commit")


def row(record: Record) -> Row:
    """A record as NAMES; what was not measured is None."""
    label = " ".join(str(value) for value in record["setting"].values())
    flat = {name: _at(record, place) for name, place in PLACES.items()}
    psnr = flat["color_psnr"]
    return {
        "asset": record["asset"],
        "codec": record["codec"],
        "setting": label,
        "bytes": record.get("bytes"),
        "faces": record.get("faces"),
        **flat,
        "color": None if psnr is None else 10 ** (-psnr / 20),
        "problem": record.get("failure") or record.get("skipped"),
        "commit": record.get("commit"),
    }


def curve(rows: Sequence[Row], asset: str, codec: str, error: str) -> list[Row]:
    """The rows of one asset and codec that have this error."""
    alike = [each for each in rows if each["asset"] == asset and each["codec"] == codec]
    return [each for each in alike if each["problem"] is None and each[error] is not None]


def pairs(rows: Sequence[Row], error: str) -> list[tuple[float, float]]:
    """(bytes, error) of each row; no error is too small for a logarithm."""
    return [(each["bytes"], max(each[error], 1e-12)) for each in rows]


def as_csv(rows: Sequence[Row]) -> str:
    """All rows with a head line."""
    text = io.StringIO()
    writer = csv.DictWriter(text, NAMES, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def from_csv(text: str) -> list[Row]:
    """The rows that `as_csv` wrote."""
    return [
        {name: _read(name, value) for name, value in each.items()}
        for each in csv.DictReader(io.StringIO(text))
    ]


def _read(name: str, value: str) -> Any:
    if name in ("asset", "codec", "setting"):
        return value
    if value == "":
        return None
    if name in ("problem", "commit"):
        return value
    return int(value) if name in ("bytes", "faces") else float(value)


def _at(record: Record, place: tuple[str, ...]) -> Any:
    value: Any = record
    for key in place:
        if not isinstance(value, dict) or key not in value:
            return None
        value = value[key]
    return value
