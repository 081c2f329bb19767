"""Numbers of a file in single precision, where that moves nothing that anybody sees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nispcodec.core.document import ChartTable, Frame


def short_frame(frame: Frame, negligible: float) -> Frame:
    """Numbers in float32 that move by no more than this share of the radius: half the bytes."""
    x, y, z, radius = _single([*frame.center, frame.radius], negligible * frame.radius)
    return Frame((x, y, z), radius)


def short_uv_map(table: ChartTable, negligible: float) -> ChartTable:
    """The map to the asset's UV, as `short_frame`; the share is that of the smaller scale."""
    limit = negligible * min(table.uv_scale)
    u, v = _single(table.uv_offset, limit)
    scale_u, scale_v = _single(table.uv_scale, limit)
    return replace(table, uv_offset=(u, v), uv_scale=(scale_u, scale_v))


def _single(values: Sequence[float], limit: float) -> list[float]:
    singles = [float(np.float32(value)) for value in values]
    pairs = zip(values, singles, strict=True)
    return [single if abs(single - value) <= limit else value for value, single in pairs]
