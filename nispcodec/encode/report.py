"""The report of an encode: held-out errors of the networks as stored."""

from __future__ import annotations

import numpy as np

from nispcodec.core.document import Document
from nispcodec.dataset.recipes import TrainingSets
from nispcodec.encode.config import EncodeConfig
from nispcodec.geometry.analysis import Analysis
from nispcodec.model import NispModel


def measured(
    document: Document, analysis: Analysis, sets: TrainingSets, config: EncodeConfig, engine: str
) -> dict[str, str | int | float | bool]:
    """By the decoder's own evaluation: mean distance, chart accuracy, UV errors; shares of area.

    Distances are in the normalized frame, UV errors in the asset's UV.
    """
    model = NispModel(document)
    near, surface = sets.held_out_distance, sets.held_out_surface
    distance = np.abs(model.sdf(near.points, frame="normalized") - near.sdf)
    found: dict[str, str | int | float | bool] = {
        "preset": config.preset,
        "seed": config.seed,
        "engine": engine,
        "hidden_share": _short(analysis.solid.hidden_share),
        "open_surface_share": _short(analysis.solid.open_surface_share),
        "distance_error": _short(distance.mean()),
    }
    charts, field = model.charts(surface.points, frame="normalized"), document.field
    if field and field.chart is not None:
        found["chart_accuracy"] = _short((charts == surface.chart).mean())
    if field and field.uv is not None:
        wanted = surface.uv * field.charts.uv_scale + field.charts.uv_offset
        off = np.linalg.norm(model.uv(surface.points, "normalized", charts) - wanted, axis=1)
        found["uv_error_median"] = _short(np.median(off))
        found["uv_error_mean"] = _short(off.mean())
    return found


def _short(value: float | np.floating) -> float:
    """Three significant digits: all that such a measurement is good for."""
    return float(f"{float(value):.3g}")
