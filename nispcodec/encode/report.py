"""The report of an encode: what the decoded surface is off, in a few numbers."""

from __future__ import annotations

import numpy as np

from nispcodec.core.document import Field
from nispcodec.core.sample_set import SampleSet
from nispcodec.encode.choice import Chosen
from nispcodec.encode.config import EncodeConfig
from nispcodec.geometry.analysis import Analysis
from nispcodec.infer.field import FieldQueries


def measured(
    chosen: Chosen,
    analysis: Analysis,
    config: EncodeConfig,
    engine: str = "",
    surface: SampleSet | None = None,
) -> dict[str, str | int | float | bool]:
    """How the file was made; mean distance, chart accuracy, UV errors; shares of area.

    Distances are in the normalized frame, UV errors in the asset's UV; both are means, or medians,
    of the larger direction between the original and what decodes. `engine` is what trained
    networks, and `surface` what their charts are judged by.
    """
    solid, errors = analysis.solid, chosen.errors
    found: dict[str, str | int | float | bool] = {"preset": config.preset, "seed": config.seed}
    if engine and chosen.document.field:
        found["engine"] = engine
    found["hidden_share"] = _short(solid.hidden_share)
    found["open_surface_share"] = _short(solid.open_surface_share)
    found["distance_error"] = _short(errors.distance)
    found["made_up_share"] = _short(errors.made_up.share)
    found["lost_share"] = _short(errors.lost.share)
    field = chosen.document.field
    if field and field.chart and surface:
        found["chart_accuracy"] = _short(_chart_accuracy(field, surface))
    if chosen.document.chart_has_uv.any():
        found["uv_error_median"] = _short(errors.uv_median)
        found["uv_error_mean"] = _short(errors.uv)
    if chosen.other_bytes:
        found["other_form_bytes"] = _short(chosen.other_bytes)
    if chosen.other_made_up:
        found["other_form_made_up_share"] = _short(chosen.other_made_up)
    return found


def unmeasured(config: EncodeConfig, field: bool) -> dict[str, str | int | float | bool]:
    """A report of at least as many bytes as `measured` will give: a size that is met counts it.

    `field` is whether the file has one.
    """
    names = (
        "hidden_share", "open_surface_share", "distance_error", "made_up_share", "lost_share",
        "uv_error_median", "uv_error_mean", "other_form_bytes", "other_form_made_up_share",
    )  # fmt: skip
    found: dict[str, str | int | float | bool] = {"preset": config.preset, "seed": config.seed}
    found |= dict.fromkeys(names, 1.23e-5)
    return found | {"engine": "native", "chart_accuracy": 1.23e-5} if field else found


def _chart_accuracy(field: Field, surface: SampleSet) -> float:
    """Share of held-out surface points whose chart the field knows."""
    return float((FieldQueries(field).charts(surface.points) == surface.chart).mean())


def _short(value: float | np.floating) -> float:
    """Three significant digits: all that such a measurement is good for."""
    return float(f"{float(value):.3g}")
