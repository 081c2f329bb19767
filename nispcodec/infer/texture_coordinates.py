"""Texture coordinates of points on known charts."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, IntArray
from nispcodec.core.document import Document
from nispcodec.infer.evaluate import evaluate


def asset_uv(document: Document, points: Float32Array, charts: IntArray) -> Float32Array:
    """UV of points (n, 3), normalized frame, on charts (n,) -> (n, 2); (0, 0) without UV."""
    if document.uv is None:
        return np.zeros((len(points), 2), np.float32)
    table = document.charts
    conditioned = document.uv.spec.conditioning != "none"
    uvs = evaluate(document.uv, points, charts if conditioned else None)
    placed = uvs * np.array(table.uv_scale, np.float32) + np.array(table.uv_offset, np.float32)
    return np.where(table.has_uv[charts][:, None], placed, np.float32(0))
