"""Creases of a mesh, the sides over which its shading breaks, and the normals between them."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int64Array, IntArray
from nispcodec.core.connectivity import connected_components, edge_ids

SHARP = np.radians(45)
"""Where nobody says which edges are creases, those are that turn by more."""
NOTHING = 1e-12
"""Vectors of this part of the longest one's length have no direction."""
MOST_SIDES = 8
"""Sides of one edge that are compared with each other: two, but for what touches there."""


def side_pairs(places: Int64Array) -> tuple[Int64Array, Int64Array]:
    """(m, 3) corner numbers -> two (k,): all pairs of sides of one edge, both ways.

    Sides are numbered 3 f + i: from corner i of face f to the next. Two faces back to back, of the
    same three corners, do not go on into each other.
    """
    edges, _ = edge_ids(places)
    order = np.argsort(edges, kind="stable")
    _, first, counts = np.unique(edges[order], return_index=True, return_counts=True)
    valence, start = np.repeat(counts, counts), np.repeat(first, counts)
    rank = np.arange(len(order)) - start
    pairs = [(np.zeros(0, np.int64), np.zeros(0, np.int64))]
    for turn in range(1, min(int(counts.max(initial=0)), MOST_SIDES)):
        chosen = np.flatnonzero(valence > turn)
        others = start[chosen] + (rank[chosen] + turn) % valence[chosen]
        pairs.append((order[chosen], order[others]))
    mine, other = (np.concatenate(each) for each in zip(*pairs, strict=True))
    across = np.roll(places, -2, axis=1).ravel()
    goes_on = across[mine] != across[other]
    return mine[goes_on], other[goes_on]


def breaking(pairs: tuple[Int64Array, Int64Array], alike: BoolArray, faces: int) -> BoolArray:
    """(faces, 3): the sides that have another one at their edge, but none that is alike.

    alike: (k,) of the pairs.
    """
    met, smooth = np.zeros(3 * faces, np.bool_), np.zeros(3 * faces, np.bool_)
    met[pairs[0]] = True
    smooth[pairs[0][alike]] = True
    return (met & ~smooth).reshape(-1, 3)


def sharp_sides(places: Int64Array, corners: Float64Array, angle: float = SHARP) -> BoolArray:
    """(m, 3): the sides whose faces' normals differ by more than `angle` (radians).

    places: (m, 3) corner numbers; corners: (m, 3, 3) positions.
    """
    normals, pairs = face_normals(corners), side_pairs(places)
    cosines = (normals[pairs[0] // 3] * normals[pairs[1] // 3]).sum(axis=1)
    return breaking(pairs, cosines >= np.cos(angle), len(places))


def fan_normals(
    places: Int64Array, corners: Float64Array, creases: BoolArray
) -> tuple[Float64Array, Int64Array]:
    """Unit normals (k, 3), and which of them (m, 3) each corner has.

    Corners of equal number that sides without crease connect have one: the mean of their faces'
    normals, weighted by their areas times the angles there; +z where these cancel. Arguments as in
    `sharp_sides`, creases (m, 3).
    """
    a, b, c = np.moveaxis(corners, 1, 0)
    crosses = np.cross(b - a, c - a)
    fans = _fans(places, _unit(crosses), creases)
    weighted = _angles(corners)[:, :, None] * crosses[:, None]
    sums = [np.bincount(fans.ravel(), weighted[:, :, axis].ravel()) for axis in range(3)]
    vectors = np.stack(sums, axis=1)
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    units = np.tile([0.0, 0.0, 1.0], (len(vectors), 1))
    np.divide(vectors, lengths, out=units, where=lengths > NOTHING * lengths.max(initial=0))
    return units, fans


def face_normals(corners: Float64Array) -> Float64Array:
    """(m, 3, 3) positions -> (m, 3): unit normals; 0 for a face without area."""
    a, b, c = np.moveaxis(corners, 1, 0)
    return _unit(np.cross(b - a, c - a))


def turned_sides(creases: BoolArray) -> BoolArray:
    """Creases (m, 3) of the same faces, the second and third corner of each swapped."""
    return creases[:, ::-1]


def _fans(places: Int64Array, normals: Float64Array, creases: BoolArray) -> Int64Array:
    mine, other = side_pairs(places)
    flat, numbers = creases.ravel(), places.ravel()
    # Of several sheets in one edge those go on into each other that face one way.
    crowded = np.bincount(mine, minlength=len(flat))[mine] > 1
    facing = (normals[mine // 3] * normals[other // 3]).sum(axis=1) > 0
    linked = ~flat[mine] & ~flat[other] & (facing | ~crowded)
    mine, other = mine[linked], other[linked]
    same = numbers[mine] == numbers[other]
    to_start, to_end = np.where(same, other, _next(other)), np.where(same, _next(other), other)
    starts, ends = np.concatenate([mine, _next(mine)]), np.concatenate([to_start, to_end])
    _, labels = connected_components(starts, ends, len(flat))
    return labels.astype(np.int64).reshape(-1, 3)


def _next(sides: IntArray) -> Int64Array:
    return np.asarray(sides - sides % 3 + (sides + 1) % 3, np.int64)


def _angles(corners: Float64Array) -> Float64Array:
    """(m, 3): the angle at each corner."""
    ways = _unit(np.roll(corners, -1, axis=1) - corners)
    cosines = -(ways * np.roll(ways, 1, axis=1)).sum(axis=2)
    return np.asarray(np.arccos(np.clip(cosines, -1, 1)))


def _unit(vectors: Float64Array) -> Float64Array:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: Float64Array = vectors / np.maximum(lengths, np.finfo(np.float64).tiny)
    return units
