"""Faces as a surface: which sides of which faces meet, and what stands for a vertex there.

A side is an edge of one face, number 3 * face + corner, from that corner to the next. Sides meet in
pairs that run opposite ways between the same two vertices; all others are borders. Which of several
meet is for the encoder to choose. Around one vertex there may then be several fans of faces: each
is a *point* of the surface with faces in one disk or half disk.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nispcodec.core.arrays import AnyArray, BoolArray, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components, edge_ids

MANY = 16
"""Sides of one edge, from which on none of them meet: choosing takes the square of their number."""


def twins(faces: Int32Array, sheet: BoolArray, unlike: Callable[[int, int], int]) -> Int64Array:
    """(m, 3) vertices -> (3 m,) int64: the side that each side meets, -1 at borders.

    Faces of sheets (m,) and others do not meet.
    unlike: how little two sides belong together, where one edge has more of them than two.
    """
    edge, way = edge_ids(faces.astype(np.int64))
    edge = 2 * edge + np.repeat(sheet, 3)
    order = np.argsort(edge, kind="stable")
    starts = np.flatnonzero(np.r_[True, edge[order][1:] != edge[order][:-1]])
    sizes = np.diff(np.r_[starts, len(edge)])
    one, other = order[starts[sizes == 2]], order[starts[sizes == 2] + 1]
    opposite = way[one] != way[other]
    one, other = one[opposite], other[opposite]
    found = np.full(len(edge), -1, np.int64)
    found[one], found[other] = other, one
    crowded = (sizes > 2) & (sizes <= MANY)
    for start, size in zip(starts[crowded].tolist(), sizes[crowded].tolist(), strict=True):
        _match(order[start : start + size], way, unlike, found)
    return found


def _match(
    sides: Int64Array, way: Int64Array, unlike: Callable[[int, int], int], found: Int64Array
) -> None:
    """Pairs the sides of one edge, in `found`, those first that belong together most."""
    there, back = sides[way[sides] > 0].tolist(), sides[way[sides] < 0].tolist()
    for _, one, other in sorted((unlike(a, b), a, b) for a in there for b in back):
        if found[one] < 0 and found[other] < 0:
            found[one], found[other] = other, one


def following(sides: AnyArray) -> AnyArray:
    """The next side of the same face, for each."""
    return sides - sides % 3 + (sides + 1) % 3


def fans(twin: Int64Array) -> Int32Array:
    """(3 m,) twins -> (3 m,) int32: the fan, from 0 up, of the corner that each side starts at."""
    sides = np.flatnonzero(twin >= 0)
    return connected_components(sides, following(twin[sides]), len(twin))[1]
