"""Which chart each vertex of an extracted surface lies on."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.core.network import Network
from nispcodec.extract.config import SeamConfig
from nispcodec.extract.isosurface import Surface
from nispcodec.infer.evaluate import classify


def vertex_charts(
    network: Network, surface: Surface, config: SeamConfig = SeamConfig()
) -> Int32Array:
    """The chart of each vertex (n,), small components of a wrong chart voted away."""
    charts = classify(network, surface.positions)
    edges = _links(surface.faces)
    least = max(config.small_vertices, round(config.small_area / surface.cell**2))
    for _ in range(config.votes):
        before, charts = charts, _without_small(charts, edges, least)
        if np.array_equal(before, charts):
            break
    return charts


def _links(faces: Int32Array) -> Int64Array:
    """The edges (e, 2) of a closed surface, each once: its two faces run along it both ways."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return sides[sides[:, 0] < sides[:, 1]].astype(np.int64)


def _without_small(charts: Int32Array, edges: Int64Array, least: int) -> Int32Array:
    """Patches of one chart with fewer than `least` vertices take the chart of most neighbors."""
    a, b = edges.T
    same = charts[a] == charts[b]
    count, patches = connected_components(a[same], b[same], len(charts))
    small = (np.bincount(patches, minlength=count) < least)[patches]
    borders = np.concatenate([edges[~same], edges[~same][:, ::-1]])
    borders = borders[small[borders[:, 0]] & ~small[borders[:, 1]]]
    votes = patches[borders[:, 0]].astype(np.int64) << 32 | charts[borders[:, 1]]
    ballots, counts = np.unique(votes, return_counts=True)
    winner_last = ballots[np.argsort(counts, kind="stable")]
    elected = np.full(count, -1, np.int32)
    elected[winner_last >> 32] = winner_last & 0xFFFFFFFF
    return np.where(elected[patches] >= 0, elected[patches], charts)
