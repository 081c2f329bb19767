"""How much a UV layout stretches the surface."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.metrics.surface import Surface

# Beyond this a triangle has collapsed, on the surface or in UV, and its number is rounding noise.
COLLAPSED = 1e6


def triangle_distortions(surface: Surface) -> Float64Array:
    """max(sigma_max, 1 / sigma_min) of each textured triangle's map from surface to UV.

    Sorkine et al. 2002, and the paper's section on distortion; the surface is in the normalized
    frame, so the number depends on the scale of the UV layout. Infinite where the UV triangle has
    no area; triangles without area on the surface are left out.
    """
    chosen = surface.mesh.has_uv & (surface.areas > 0)
    corners, uvs = surface.corners_of(chosen), surface.mesh.corner_uvs[chosen]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    s, t = uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]
    # The triangle in its own plane: a along the first axis, b = (across, height).
    length = np.linalg.norm(a, axis=1)
    across = (a * b).sum(axis=1) / length
    height = 2 * surface.areas[chosen] / length
    first = s / length[:, None]
    second = (t - first * across[:, None]) / height[:, None]
    large, small = _singular_values(first, second)
    with np.errstate(divide="ignore"):
        distortions: Float64Array = np.maximum(large, 1 / small)
    return distortions


def _singular_values(
    first: Float64Array, second: Float64Array
) -> tuple[Float64Array, Float64Array]:
    """Of 2 x 2 matrices given by their columns (n, 2): the larger and the smaller (n,)."""
    # A matrix is a rotation with scaling plus a reflection with scaling (Blinn 1996).
    turned = np.hypot(first[:, 0] + second[:, 1], first[:, 1] - second[:, 0]) / 2
    mirrored = np.hypot(first[:, 0] - second[:, 1], first[:, 1] + second[:, 0]) / 2
    return turned + mirrored, np.abs(turned - mirrored)


def distortion_summary(surface: Surface) -> dict[str, float]:
    """Mean, maximum and standard deviation over triangles (paper, table of distortions).

    Collapsed triangles do not enter; their share does. Empty when no triangle remains.
    """
    every = triangle_distortions(surface)
    distortions = every[every < COLLAPSED]
    if len(distortions) == 0:
        return {}
    return {
        "collapsed": 1 - len(distortions) / len(every),
        "mean": float(distortions.mean()),
        "max": float(distortions.max()),
        "std": float(distortions.std()),
    }
