"""Fewer triangles by quadric edge collapse (Garland and Heckbert, 1997).

The bare surface is simplified, before charts and UVs are looked up: seams are then cut into the
simplified triangles exactly as into the extracted ones, and every UV is still the network's own.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.network import Network
from nispcodec.extract.config import SimplifyConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.manifold import manifold
from nispcodec.infer.evaluate import evaluate


def simplified(surface: Surface, faces: int, config: SimplifyConfig = SimplifyConfig()) -> Surface:
    """The surface with about `faces` triangles, or as it is when it has no more than that.

    Its vertices lie where they serve the triangles best, no longer on the zero set.
    """
    if len(surface.faces) <= faces:
        return surface
    from fast_simplification import simplify

    # On exactly flat parts all quadrics are 0 and collapses get stuck: make them a little rough.
    scale, shape = config.roughness * surface.cell, surface.positions.shape
    rough = surface.positions + np.random.default_rng(0).normal(0, scale, shape).astype(np.float32)
    eager = config.aggressiveness
    positions, corners = simplify(rough, surface.faces, target_count=faces, agg=eager)
    fewer = Surface(positions.astype(np.float32), corners.astype(np.int32), surface.cell)
    # Sheets taken apart may leave two faces that have nothing but each other.
    return without_fins(manifold(without_fins(fewer), config.retreat))


def without_fins(surface: Surface) -> Surface:
    """The surface without pairs of faces back to back, to which thin parts collapse."""
    corners = np.sort(surface.faces, axis=1)
    _, first, twin, count = np.unique(
        corners, axis=0, return_index=True, return_inverse=True, return_counts=True
    )
    twin = twin.ravel()
    rising = (surface.faces < np.roll(surface.faces, -1, axis=1)).sum(axis=1)
    agreeing = np.bincount(twin, rising == rising[first[twin]], minlength=len(first))
    faces = surface.faces[~((count == 2) & (agreeing == 1))[twin]]
    used, renumbered = np.unique(faces, return_inverse=True)
    return Surface(
        surface.positions[used], renumbered.reshape(-1, 3).astype(np.int32), surface.cell
    )


def simplest(
    network: Network, surface: Surface, error: float, config: SimplifyConfig = SimplifyConfig()
) -> Surface:
    """The surface with fewer triangles, as long as its deviation stays within `error`."""
    while True:
        fewer = simplified(surface, int(config.shrinkage * len(surface.faces)), config)
        stuck = len(fewer.faces) >= len(surface.faces)
        if stuck or deviation(network, fewer) > error:
            return surface
        surface = fewer


def deviation(network: Network, surface: Surface) -> float:
    """Mean distance of the triangles to the zero set, area-weighted, normalized frame.

    The field's value at centroids and at the middles of edges stands for the distance.
    """
    corners = surface.positions[surface.faces]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    points = np.concatenate([middles, corners.mean(axis=1, keepdims=True)], axis=1)
    distances = np.abs(evaluate(network, points.reshape(-1, 3))).reshape(-1, 4).mean(axis=1)
    a, b, c = corners.transpose(1, 0, 2)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return float(np.average(distances, weights=areas)) if areas.any() else 0.0
