"""`.nisp` against the line to beat: rates at equal error, bytes at fixed errors, costs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.rate_distortion.bjontegaard import delta_rate, front
from benchmarks.rate_distortion.rows import ERRORS, Row, curve, pairs

OURS = "nisp"
RIVALS = (
    "draco", "simplified_draco", "simplified_update_draco", "simplified_update_meshopt",
    "simplified_gltfpack",
)  # fmt: skip
"""The codecs whose best settings are the line to beat."""
LEVELS = {
    "distance": (2e-3, 1.5e-3, 1e-3, 7e-4, 5e-4, 3.5e-4),
    "uv": (2e-2, 1e-2, 5e-3, 2e-3),
    "uv_median": (2e-3, 1e-3, 5e-4, 3e-4),
}
COSTS = ("encode_seconds", "encode_peak_bytes", "decode_seconds", "decode_peak_bytes")

Summary = dict[str, Any]


def summarized(rows: Sequence[Row]) -> Summary:
    """Everything, by asset; the means are over assets."""
    assets = sorted({row["asset"] for row in rows})
    codecs = sorted({row["codec"] for row in rows})
    rates = {asset: delta_rates(rows, asset) for asset in assets}
    return {
        "delta_rate": rates,
        "mean_delta_rate": {error: _mean([rates[a][error] for a in assets]) for error in ERRORS},
        "against_rival": {asset: duels(rows, asset) for asset in assets},
        "bytes_at": {asset: fixed(rows, asset, codecs) for asset in assets},
        "costs": {codec: costs(rows, codec) for codec in codecs},
    }


def delta_rates(rows: Sequence[Row], asset: str) -> dict[str, float | None]:
    """Bjontegaard-delta rate of ours against the rival, for every error; None with few points."""
    both = {
        error: [
            pairs(points, error)
            for points in (rivals(rows, asset, error), curve(rows, asset, OURS, error))
        ]
        for error in ERRORS
    }
    return {error: delta_rate(*curves) for error, curves in both.items()}


def rivals(rows: Sequence[Row], asset: str, error: str) -> list[Row]:
    """The points of every rival that have this error."""
    return [each for codec in RIVALS for each in curve(rows, asset, codec, error)]


def duels(rows: Sequence[Row], asset: str) -> list[Summary]:
    """Each of our points, and the fewest bytes with which a rival is as good.

    In the distance; in the UVs (mean, median); in distance and mean UV error at once. None where
    no setting of a rival is.
    """
    theirs = rivals(rows, asset, "distance")
    demands = [["distance"], ["uv"], ["uv_median"], ["distance", "uv"]]
    return [
        {
            "setting": ours["setting"],
            "bytes": ours["bytes"],
            "rival_bytes": {" and ".join(names): _fewest(theirs, ours, names) for names in demands},
        }
        for ours in curve(rows, asset, OURS, "distance")
    ]


def fixed(rows: Sequence[Row], asset: str, codecs: Sequence[str]) -> Summary:
    """Error -> level -> codec -> the fewest bytes that stay within it."""
    return {
        error: {
            f"{level:g}": {
                codec: bytes_at(pairs(curve(rows, asset, codec, error), error), level)
                for codec in codecs
            }
            for level in levels
        }
        for error, levels in LEVELS.items()
    }


def bytes_at(points: Sequence[tuple[float, float]], level: float) -> int | None:
    """The fewest bytes of any point with at most this error."""
    return next((int(size) for size, error in front(points) if error <= level), None)


def bytes_between(points: Sequence[tuple[float, float]], level: float) -> int | None:
    """Bytes at which the front of (bytes, error), straight in logarithms, has fallen to an error.

    Files between two settings can be had, by another count of faces. The fewest bytes of all where
    they suffice, None where none do.
    """
    best = front(points)
    if not len(best) or level < best[-1, 1]:
        return None
    sizes, errors = np.log(best[::-1]).T
    return round(float(np.exp(np.interp(np.log(level), errors, sizes))))


def costs(rows: Sequence[Row], codec: str) -> dict[str, float | None]:
    """Median time and memory over all points of a codec."""
    alike = [row for row in rows if row["codec"] == codec and row["problem"] is None]
    return {name: _median([row[name] for row in alike]) for name in COSTS}


def _fewest(rivals: Sequence[Row], ours: Row, names: Sequence[str]) -> int | None:
    if any(ours[name] is None for name in names):
        return None
    good = [rival for rival in rivals if all(_within(rival[name], ours[name]) for name in names)]
    return min((rival["bytes"] for rival in good), default=None)


def _within(value: float | None, limit: float) -> bool:
    return value is not None and value <= limit


def _mean(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.mean(known)) if known else None


def _median(values: Sequence[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return float(np.median(known)) if known else None
