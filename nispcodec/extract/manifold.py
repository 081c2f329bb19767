"""Taking sheets of a surface apart that touch along edges or in vertices.

Edge collapses may close a thin tunnel or flatten a thin tube; four faces then meet at one edge.
Such an edge becomes two, each with the two faces that bound the same solid part.
"""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.extract.config import SimplifyConfig
from nispcodec.extract.isosurface import Surface

Twins = tuple[Int64Array, Int64Array]


def manifold(surface: Surface, retreat: float = SimplifyConfig.retreat) -> Surface:
    """The oriented surface, every edge with two faces and one fan of faces at every vertex.

    It is closed, or ends at the edge of the grid as a field does that has no end there. A vertex
    gets one copy for each sheet that passes through it. Two vertices that are joined by two edges,
    as across a tunnel pinched shut, get a vertex in the middle of each. Copies draw back to their
    own faces by `retreat`, a share of these faces' size.
    """
    twins = _twins(surface)
    apart = _apart(surface, twins, retreat)
    return _halved(apart, _doubled(apart.faces, twins), retreat)


def _apart(surface: Surface, twins: Twins, retreat: float) -> Surface:
    keys = surface.faces.ravel().astype(np.int64) << 32 | _sheets(twins, surface.faces.size)
    names, copies = np.unique(keys, return_inverse=True)
    origins, faces = names >> 32, copies.reshape(-1, 3).astype(np.int32)
    positions = surface.positions[origins]
    shared = np.bincount(origins)[origins] > 1
    sums = np.zeros(positions.shape)
    np.add.at(sums, faces.ravel(), np.repeat(positions[faces].mean(axis=1), 3, axis=0))
    centers = sums / np.bincount(faces.ravel())[:, None]
    drawn = np.where(shared[:, None], positions + retreat * (centers - positions), positions)
    return Surface(drawn.astype(np.float32), faces, surface.cell)


def _sheets(twins: Twins, count: int) -> Int32Array:
    """The sheet of each of `count` corners: corners of one vertex that are joined across edges."""
    one, other = twins
    # Half-edge h starts at corner h and ends at the face's following corner.
    after = np.arange(count).reshape(-1, 3)[:, [1, 2, 0]].ravel()
    starts, ends = np.concatenate([one, after[one]]), np.concatenate([after[other], other])
    return connected_components(starts, ends, count)[1]


def _doubled(faces: Int32Array, twins: Twins) -> Int64Array:
    """Twins (t, 2), half-edges, that run between the same two vertices as others."""
    starts, ends = faces.ravel().astype(np.int64), np.roll(faces, -1, axis=1).ravel()
    keys = starts << 32 | ends
    _, edge, counts = np.unique(keys[twins[0]], return_inverse=True, return_counts=True)
    return np.stack(twins, axis=1)[counts[edge] > 1]


def _halved(surface: Surface, twins: Int64Array, retreat: float) -> Surface:
    """The surface with a new vertex in the middle of each pair of half-edges (t, 2)."""
    first = len(surface.positions)
    middles = {half: first + row for row, pair in enumerate(twins.tolist()) for half in pair}
    touched = np.unique(twins // 3)
    pieces = [piece for face in touched.tolist() for piece in _fan(surface.faces, face, middles)]
    faces = np.vstack([np.delete(surface.faces, touched, axis=0), *pieces]).astype(np.int32)
    corners = surface.positions[surface.faces[twins // 3]]
    ends = np.stack([corners[:, 0][np.arange(len(twins)), (twins[:, 0] + i) % 3] for i in (0, 1)])
    middle, centers = ends.mean(axis=0), corners.mean(axis=(1, 2))
    new = (middle + retreat * (centers - middle)).astype(np.float32)
    return Surface(np.vstack([surface.positions, new]), faces, surface.cell)


def _fan(faces: Int32Array, face: int, middles: dict[int, int]) -> list[list[int]]:
    """The triangles of a face with new vertices on some sides, round one of these."""
    loop = []
    for side in range(3):
        loop.append(int(faces[face, side]))
        if 3 * face + side in middles:
            loop.append(middles[3 * face + side])
            start = len(loop) - 1
    turned = loop[start:] + loop[:start]
    return [[turned[0], turned[i], turned[i + 1]] for i in range(1, len(turned) - 1)]


def _twins(surface: Surface) -> Twins:
    """Every half-edge that runs from a lower to a higher vertex, and the half-edge it joins.

    Where several faces run up an edge, the first of them joins the first face downwards that is met
    on turning through the solid behind it, and so on round the edge. Those that find none are left
    out.
    """
    starts = surface.faces.ravel().astype(np.int64)
    ends = np.roll(surface.faces, -1, axis=1).ravel()
    down = starts > ends
    keys = np.minimum(starts, ends) << 32 | np.maximum(starts, ends)
    order = np.lexsort([_turns(surface, keys, down), keys, down])
    up, joined = np.split(order, [len(order) - np.count_nonzero(down)])
    if np.array_equal(keys[up], keys[joined]):
        return up, joined
    edges = np.unique(keys, return_inverse=True)[1]
    rising, falling = _with_partners(edges[up], edges[joined])
    return up[rising], joined[falling]


def _with_partners(one: Int64Array, other: Int64Array) -> Twins:
    """The places in two sorted arrays of numbers: the k-th of a number in one, and in the other."""
    ranks = [np.arange(len(each)) - np.searchsorted(each, each) for each in (one, other)]
    most = max(int(each.max(initial=0)) for each in ranks) + 1
    first, second = one * most + ranks[0], other * most + ranks[1]
    return np.intersect1d(first, second, assume_unique=True, return_indices=True)[1:]


def _turns(surface: Surface, keys: Int64Array, down: BoolArray) -> Float64Array:
    """How far (3m,) each half-edge's face is turned round its edge from the edge's first face.

    Radians in [0, 2 pi), through the solid first; 0 where an edge has but two faces.
    """
    edges, edge, counts = np.unique(keys, return_inverse=True, return_counts=True)
    crowded = np.flatnonzero(counts[edge] > 2)
    positions = surface.positions.astype(np.float64)
    start, end = positions[keys[crowded] >> 32], positions[keys[crowded] & 0xFFFFFFFF]
    axis = (end - start) / np.linalg.norm(end - start, axis=1, keepdims=True)
    outwards = positions[surface.faces[crowded // 3, (crowded + 2) % 3]] - start
    rising = np.flatnonzero(~down[crowded])
    first = np.zeros(len(edges), np.int64)
    first[edge[crowded[rising[::-1]]]] = rising[::-1]
    right = np.cross(axis, np.cross(outwards, axis))[first[edge[crowded]]]
    ahead = np.cross(right, axis)
    dots = [(outwards * side).sum(axis=1) for side in (ahead, right)]
    turns = np.zeros(len(keys))
    # Rounding must not turn the first face by a whole turn.
    turns[crowded] = (np.arctan2(*dots) + 1e-9) % (2 * np.pi)
    return turns
