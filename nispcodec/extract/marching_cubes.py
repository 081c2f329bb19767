"""Marching cubes over a list of cells, in numpy; the case table is computed, not typed in.

Each case's crossed edges are joined face by face, a rule that looks at the four corners of the face
only: two cells that share a face therefore agree on it, and the surface has no cracks. On a face
with two opposite corners inside, the inside corners are kept apart.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from nispcodec.core.arrays import Int8Array, Int64Array, Uint8Array

# Corner i of a cell lies at the bits of i: x = i & 1, y = i >> 1 & 1, z = i >> 2.
CORNERS = np.array([(i & 1, i >> 1 & 1, i >> 2) for i in range(8)])
# Edge: (low corner, axis); its high corner is low | 1 << axis.
EDGES = [(low, axis) for axis in range(3) for low in range(8) if not low >> axis & 1]


@cache
def triangle_table() -> tuple[Int8Array, Int64Array]:
    """Triangles of all 256 cases, case after case, and where each case starts.

    -> triangles (t, 3) int8 edge numbers into EDGES, wound counter-clockwise seen from outside
    (where corner bits are 0); starts (257,) into triangles. Bit i of a case: corner i is inside.
    """
    triangles, starts = [], [0]
    for case in range(256):
        for loop in _loops(case):
            triangles += _triangulated(loop)
        starts.append(len(triangles))
    return np.array(triangles, np.int8), np.array(starts)


def polygonize(cases: Uint8Array) -> tuple[Int64Array, Int8Array]:
    """Triangles of many cells: cases (n,) -> cell of each triangle (t,), its edges (t, 3)."""
    table, starts = triangle_table()
    counts = (starts[1:] - starts[:-1])[cases]
    cells = np.repeat(np.arange(len(cases)), counts)
    within = np.arange(len(cells)) - np.repeat(np.cumsum(counts) - counts, counts)
    return cells, table[starts[cases][cells] + within]


def _faces() -> list[tuple[int, int, int, int]]:
    """Each face's four corners, counter-clockwise seen from outside the cell."""
    faces = []
    for axis in range(3):
        u, v = 1 << (axis + 1) % 3, 1 << (axis + 2) % 3
        high = 1 << axis
        faces.append((high, high | u, high | u | v, high | v))
        faces.append((0, v, u | v, u))
    return faces


def _edge_between(a: int, b: int) -> int:
    return EDGES.index((min(a, b), (a ^ b).bit_length() - 1))


def _loops(case: int) -> list[list[int]]:
    """The closed polygons in which the surface leaves the cell's faces, as edge numbers."""
    follows: dict[int, int] = {}
    for face in _faces():
        inside = [bool(case >> corner & 1) for corner in face]
        for i in range(4):
            if inside[i] and not inside[i - 1]:
                # A run of inside corners starts at i; the surface cuts it off from the rest.
                run = next(k for k in range(1, 4) if not inside[(i + k) % 4])
                enters = _edge_between(face[i - 1], face[i])
                leaves = _edge_between(face[(i + run - 1) % 4], face[(i + run) % 4])
                follows[enters] = leaves
    loops = []
    while follows:
        loop = [next(iter(follows))]
        while (after := follows.pop(loop[-1])) != loop[0]:
            loop.append(after)
        loops.append(loop)
    return loops


def _triangulated(loop: list[int]) -> list[tuple[int, int, int]]:
    """Fan of the loop from the vertex whose chords stay off the cell's faces.

    A chord in a face could also be drawn by the neighbor: four triangles would meet at it.
    """
    count = len(loop)
    for start in range(count):
        turned = loop[start:] + loop[:start]
        if not any(_on_one_face(turned[0], other) for other in turned[2:-1]):
            return [(turned[0], turned[i], turned[i + 1]) for i in range(1, count - 1)]
    raise AssertionError("every loop has a fan inside the cell")


def _on_one_face(a: int, b: int) -> bool:
    ends = [{low, low | 1 << axis} for low, axis in (EDGES[a], EDGES[b])]
    return any(ends[0] | ends[1] <= set(face) for face in _faces())
