"""Faces as a surface: which sides of which faces meet, and what stands for a vertex there.

A side is an edge of one face, number 3 * face + corner, from that corner to the next. Two sides
meet where they are the only ones between their two vertices, and run opposite ways; all others are
borders, those of edges with three faces included. Around one vertex there may then be several fans
of faces: each is a *point* of the surface with faces in one disk or half disk.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import AnyArray, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components, edge_ids


def twins(faces: Int32Array) -> Int64Array:
    """(m, 3) vertices -> (3 m,) int64: the side that each side meets, -1 at borders."""
    edge, way = edge_ids(faces.astype(np.int64))
    order = np.argsort(edge, kind="stable")
    sorted_edges, sorted_ways = edge[order], way[order]
    starts = np.flatnonzero(np.r_[True, sorted_edges[1:] != sorted_edges[:-1]])
    sizes = np.diff(np.r_[starts, len(edge)])
    pairs = starts[sizes == 2]
    pairs = pairs[sorted_ways[pairs] != sorted_ways[pairs + 1]]
    found = np.full(len(edge), -1, np.int64)
    found[order[pairs]], found[order[pairs + 1]] = order[pairs + 1], order[pairs]
    return found


def following(sides: AnyArray) -> AnyArray:
    """The next side of the same face, for each."""
    return sides - sides % 3 + (sides + 1) % 3


def fans(twin: Int64Array) -> Int32Array:
    """(3 m,) twins -> (3 m,) int32: the fan, from 0 up, of the corner that each side starts at."""
    sides = np.flatnonzero(twin >= 0)
    return connected_components(sides, following(twin[sides]), len(twin))[1]
