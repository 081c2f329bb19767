"""How much a UV layout stretches the surface."""

from __future__ import annotations

import numpy as np

from nispcodec.metrics.surface import Array, Surface


def triangle_distortions(surface: Surface) -> Array:
    """max(sigma_max, 1 / sigma_min) of each textured triangle's map from surface to UV.

    Sorkine et al. 2002, and the paper's section on distortion; the surface is in the normalised
    frame, so the number depends on the scale of the UV layout. Triangles without area on the
    surface or in UV have no such number and are left out.
    """
    chosen = surface.mesh.has_uv & (surface.areas > 0)
    corners, uvs = surface.corners[chosen], surface.mesh.corner_uvs[chosen]
    edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
    uv_edges = np.stack([uvs[:, 1] - uvs[:, 0], uvs[:, 2] - uvs[:, 0]], axis=2)
    # QR turns each triangle into its own plane; the map is then the 2 x 2 matrix uv_edges R^-1.
    jacobians = uv_edges @ np.linalg.inv(np.linalg.qr(edges).R)
    sigmas = np.linalg.svd(jacobians, compute_uv=False)
    sigmas = sigmas[sigmas[:, 1] > 0]
    distortions: Array = np.maximum(sigmas[:, 0], 1 / sigmas[:, 1])
    return distortions


def distortion_summary(surface: Surface) -> dict[str, float]:
    """Mean, maximum and standard deviation over triangles (paper, table of distortions)."""
    distortions = triangle_distortions(surface)
    if len(distortions) == 0:
        return {}
    return {
        "mean": float(distortions.mean()),
        "max": float(distortions.max()),
        "std": float(distortions.std()),
    }
