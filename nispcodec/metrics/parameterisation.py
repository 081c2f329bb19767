"""How much a UV layout stretches the surface."""

from __future__ import annotations

import numpy as np

from nispcodec.metrics.surface import Array, Surface

# Beyond this a triangle has collapsed, on the surface or in UV, and its number is rounding noise.
COLLAPSED = 1e6


def triangle_distortions(surface: Surface) -> Array:
    """max(sigma_max, 1 / sigma_min) of each textured triangle's map from surface to UV.

    Sorkine et al. 2002, and the paper's section on distortion; the surface is in the normalised
    frame, so the number depends on the scale of the UV layout. Infinite where the UV triangle has
    no area; triangles without area on the surface are left out.
    """
    chosen = surface.mesh.has_uv & (surface.areas > 0)
    corners, uvs = surface.corners[chosen], surface.mesh.corner_uvs[chosen]
    edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
    uv_edges = np.stack([uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]], axis=2)
    # QR turns each triangle into its own plane; the map is then the 2 x 2 matrix uv_edges R^-1.
    jacobians = uv_edges @ np.linalg.inv(np.linalg.qr(edges).R)
    sigmas = np.linalg.svd(jacobians, compute_uv=False)
    with np.errstate(divide="ignore"):
        distortions: Array = np.maximum(sigmas[:, 0], 1 / sigmas[:, 1])
    return distortions


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
