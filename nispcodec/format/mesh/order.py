"""In which order values at nodes are coded, and from which known ones each is predicted.

A node is a vertex, or what of a vertex lies in one chart. The next one is that with most faces
whose other two nodes are known: so each value is predicted from as many sides as can be.
"""

from __future__ import annotations

from collections.abc import Iterator

MOST = 3
HINGES = 16
Hinges = list[tuple[int, int, int]]
"""For each face with two known nodes these two, a and b, and c, the node that lies over their edge;
-1 where none is known there."""


def visits(
    corners: list[int], twin: list[int], known: list[bool]
) -> Iterator[tuple[int, Hinges, int]]:
    """Nodes, each with its hinges and, where it has none, a known node of one of its faces or -1.

    corners (3 m) nodes; twin (3 m) the side that each side meets. Changes `known` (n), in which a
    node must not be known before it is visited; all are in the end.
    """
    corners_at: list[list[int]] = [[] for _ in known]
    for corner, node in enumerate(corners):
        corners_at[node].append(corner)
    ready, faces_known = [0] * len(known), [0] * (len(corners) // 3)
    buckets: list[list[int]] = [[] for _ in range(MOST + 1)]
    for first in corners:
        buckets[0].append(first)
        while (node := _best(buckets, known)) >= 0:
            yield node, *_sources(node, corners, twin, known, corners_at)
            known[node] = True
            for corner in corners_at[node]:
                face = corner // 3
                faces_known[face] += 1
                if faces_known[face] == 2:
                    for other in corners[3 * face : 3 * face + 3]:
                        if not known[other]:
                            ready[other] += 1
                            buckets[min(ready[other], MOST)].append(other)


def _best(buckets: list[list[int]], known: list[bool]) -> int:
    for bucket in reversed(buckets):
        while bucket:
            node = bucket.pop()
            if not known[node]:
                return node
    return -1


def _sources(
    node: int, corners: list[int], twin: list[int], known: list[bool], corners_at: list[list[int]]
) -> tuple[Hinges, int]:
    hinges: Hinges = []
    near = -1
    for corner in corners_at[node]:
        base, turn = corner - corner % 3, corner % 3
        opposite, last = base + (turn + 1) % 3, base + (turn + 2) % 3
        a, b = corners[opposite], corners[last]
        if known[a] and known[b]:
            if len(hinges) == HINGES:
                break
            over = twin[opposite]
            c = corners[over - over % 3 + (over + 2) % 3] if over >= 0 else -1
            hinges.append((a, b, c if c >= 0 and known[c] else -1))
        elif known[a]:
            near = a
        elif known[b]:
            near = b
    return hinges, near
