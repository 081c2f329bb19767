"""How far the texture coordinates of paired points differ."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.metrics.geometry import Matches
from nispcodec.metrics.surface import Surface, SurfacePoints


def uv_at(surface: Surface, points: SurfacePoints) -> Float64Array:
    """(n, 2): UVs at points of a surface, origin bottom-left; (0, 0) where the face has none."""
    uvs: Float64Array = np.einsum("nk,nkd->nd", points.weights, surface.mesh.uvs_at(points.faces))
    return uvs


def uv_errors(original: Surface, decoded: Surface, matches: Matches) -> Float64Array:
    """(k,): Euclidean distances in UV of those pairs whose original face has UVs."""
    textured = original.mesh.has_uv[matches.original.faces]
    first = uv_at(original, matches.original[textured])
    second = uv_at(decoded, matches.decoded[textured])
    errors: Float64Array = np.linalg.norm(second - first, axis=1)
    return errors


def uv_summary(errors: Float64Array) -> dict[str, float]:
    """Mean, median and 99th percentile of (k,) UV errors."""
    return {
        "mean": float(errors.mean()),
        "median": float(np.median(errors)),
        "p99": float(np.percentile(errors, 99)),
    }
