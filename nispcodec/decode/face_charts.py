"""Which chart each face of an extracted surface lies on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from nispcodec.decode.evaluate import evaluate
from nispcodec.decode.extract import Surface
from nispcodec.network import Network

SPECK = 4
ROUNDS = 3

Integers = NDArray[np.int32]
Ids = NDArray[np.int64]


def predicted_charts(network: Network | None, points: NDArray[np.float32]) -> Integers:
    """The most likely chart at each point: (n, 3) float32, normalised frame -> (n,) int32."""
    if network is None:
        return np.zeros(len(points), np.int32)
    charts: Integers = evaluate(network, points).argmax(axis=1).astype(np.int32)
    return charts


def face_charts(network: Network | None, surface: Surface) -> Integers:
    """One chart a face (m,): majority of corners and centroid, then specks voted away."""
    if network is None:
        return np.zeros(len(surface.faces), np.int32)
    corners = predicted_charts(network, surface.positions)[surface.faces]
    centroids = surface.positions[surface.faces].mean(axis=1)
    charts = _majority(corners, predicted_charts(network, centroids))
    neighbours = _neighbours(surface.faces)
    for _ in range(ROUNDS):
        charts = _without_specks(charts, neighbours)
    return charts


def _majority(corners: Integers, centre: Integers) -> Integers:
    """The chart that two corners or a corner and the centre share; the centre's otherwise."""
    a, b, c = corners.T
    agreed = np.where((b == c) & (a != centre) & (b != centre), b, centre)
    agreed = np.where((a == b) & (c != centre), a, agreed)
    return np.where((a == c) & (b != centre), a, agreed).astype(np.int32)


def _neighbours(faces: Integers) -> Ids:
    """Pairs of faces (p, 2) that share an edge."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    keys = edges[:, 0].astype(np.int64) << 32 | edges[:, 1]
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    owners = order % len(faces)
    return np.column_stack([owners[:-1][same], owners[1:][same]])


def _without_specks(charts: Integers, neighbours: Ids) -> Integers:
    """Components of fewer than SPECK faces take the chart of their longest border."""
    a, b = neighbours.T
    same = charts[a] == charts[b]
    size = len(charts)
    graph = coo_array((same[same], (a[same], b[same])), shape=(size, size))
    count, labels = connected_components(graph, directed=False)
    tiny = np.bincount(labels, minlength=count) < SPECK
    outgoing = np.concatenate([neighbours[~same], neighbours[~same][:, ::-1]])
    outgoing = outgoing[tiny[labels[outgoing[:, 0]]] & ~tiny[labels[outgoing[:, 1]]]]
    borders = labels[outgoing[:, 0]].astype(np.int64) << 32 | charts[outgoing[:, 1]]
    pairs, lengths = np.unique(borders, return_counts=True)
    longest_last = np.argsort(lengths, kind="stable")
    taken = np.full(count, -1, np.int32)
    taken[pairs[longest_last] >> 32] = pairs[longest_last] & 0xFFFFFFFF
    return np.where(taken[labels] >= 0, taken[labels], charts)
