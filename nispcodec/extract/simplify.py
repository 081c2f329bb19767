"""Fewer triangles by quadric edge collapse (Garland and Heckbert, 1997).

The bare surface is simplified, before charts and UVs are looked up: seams are then cut into the
simplified triangles exactly as into the extracted ones, and every UV is still the network's own.
"""

from __future__ import annotations

import math

import numpy as np

from nispcodec.core.arrays import Float64Array
from nispcodec.core.network import Network
from nispcodec.extract.config import SimplifyConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.extract.manifold import manifold
from nispcodec.infer.evaluate import evaluate, gradient


def simplified(
    network: Network, surface: Surface, faces: int, config: SimplifyConfig = SimplifyConfig()
) -> Surface:
    """The surface with about `faces` triangles, or as it is when it has no more than that.

    Its vertices lie where they serve the triangles best, no longer on the zero set. There are more
    triangles where so few would leave nothing.
    """
    if len(surface.faces) <= faces:
        return surface
    found = _finished(network, surface, _collapsed(surface, faces, config), config)
    return found if len(found.faces) else simplified(network, surface, 2 * max(faces, 1), config)


def _collapsed(surface: Surface, faces: int, config: SimplifyConfig) -> Surface:
    """The surface with about `faces` triangles; some of its parts may have come to touch."""
    from fast_simplification import simplify

    # On exactly flat parts all quadrics are 0 and collapses get stuck: make them a little rough.
    scale, shape = config.roughness * surface.cell, surface.positions.shape
    rough = surface.positions + np.random.default_rng(0).normal(0, scale, shape).astype(np.float32)
    eager = config.aggressiveness
    positions, corners = simplify(rough, surface.faces, target_count=faces, agg=eager)
    return Surface(positions.astype(np.float32), corners.astype(np.int32), surface.cell)


def _finished(
    network: Network, surface: Surface, collapsed: Surface, config: SimplifyConfig
) -> Surface:
    """A simplified surface with parts that touch taken apart, fitted to the field."""
    # Sheets taken apart may leave two faces that have nothing but each other.
    apart = without_fins(manifold(without_fins(collapsed), config.retreat))
    coarser = np.sqrt(len(surface.positions) / max(len(apart.positions), 1))
    spaced = Surface(apart.positions, apart.faces, surface.cell * float(coarser))
    return fitted(network, spaced, config)


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
    network: Network,
    surface: Surface,
    error: float,
    most: int | None = None,
    config: SimplifyConfig = SimplifyConfig(),
) -> Surface:
    """The surface with about as few triangles as keep its deviation within `error`.

    Fewer and fewer are tried, as many as the last ones' deviation foretells; where those are too
    few, more. Simplifying what is simple already takes little time. There are hardly more than
    `most` after seams are cut, whatever the deviation.
    """
    whole = len(surface.faces)
    bare = math.inf if most is None else config.bare * most
    bounded = bare < config.close * whole
    fewest, share = surface, bare / whole if bounded else config.first
    while share < config.close:
        fewer = _collapsed(fewest, int(share * len(fewest.faces)), config)
        left = config.fitting * deviation(network, fewer, config.measured)
        foretold = (left / error) ** config.slope
        if len(fewer.faces) >= config.close * len(fewest.faces):
            break
        if foretold <= 1 or (bounded and len(fewest.faces) > bare):
            fewest, share = fewer, max(foretold, config.shrinkage)
        else:
            share *= max(foretold, config.more)
    return fewest if fewest is surface else _finished(network, surface, fewest, config)


def fitted(
    network: Network, surface: Surface, config: SimplifyConfig = SimplifyConfig()
) -> Surface:
    """The surface, its vertices moved along the field's gradient to where triangles serve best.

    The signed distances of the triangles around each vertex come to a mean of about 0.
    """
    distances, areas = _distances(network, surface)
    sides = distances[:, :3]
    felt = (sides + np.roll(sides, 1, axis=1)) / 2 + distances[:, 3:] / 3
    corners, count = surface.faces.ravel(), len(surface.positions)
    sums = np.bincount(corners, (areas[:, None] * felt).ravel(), minlength=count)
    weights = np.bincount(corners, np.repeat(areas, 3), minlength=count) * (4 / 3)
    slopes = gradient(network, surface.positions)[1].astype(np.float64)
    normals = slopes / np.maximum(np.linalg.norm(slopes, axis=1, keepdims=True), 1e-6)
    moves = config.step * sums / np.maximum(weights, np.finfo(np.float64).tiny)
    moved = surface.positions - moves[:, None] * normals
    return Surface(moved.astype(np.float32), surface.faces, surface.cell)


def deviation(network: Network, surface: Surface, faces: int | None = None) -> float:
    """Mean distance of the triangles to the zero set, area-weighted, normalized frame.

    The field's value at centroids and at the middles of edges stands for the distance. It is
    measured on about `faces` triangles, or on all.
    """
    every = max(1, len(surface.faces) // faces) if faces else 1
    part = Surface(surface.positions, surface.faces[::every], surface.cell)
    distances, areas = _distances(network, part)
    return float(np.average(np.abs(distances).mean(axis=1), weights=areas)) if areas.any() else 0.0


def _distances(network: Network, surface: Surface) -> tuple[Float64Array, Float64Array]:
    """The field (m, 4) at the middle of each side and the centroid of each face; areas (m,)."""
    corners = surface.positions[surface.faces]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    points = np.concatenate([middles, corners.mean(axis=1, keepdims=True)], axis=1)
    distances = evaluate(network, points.reshape(-1, 3)).reshape(-1, 4).astype(np.float64)
    a, b, c = corners.astype(np.float64).transpose(1, 0, 2)
    return distances, np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
