"""Charts that meet themselves: a cylinder unrolled by one cut has a seam inside one chart.

Across such a seam the UV jumps but the chart does not, and no smooth network can follow. Cutting
the chart between the sides of the seam leaves every jump on a border between charts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

from nispcodec.core.arrays import Float64Array, Int64Array, IntArray
from nispcodec.core.connectivity import connected_faces, row_ids
from nispcodec.geometry.charts import Charts, colored
from nispcodec.geometry.welding import Welding


def split_self_seams(points: Float64Array, welding: Welding, charts: Charts) -> Charts:
    """The charts, with those that meet themselves cut so that no seam has one chart on both sides.

    Corners along one side of a seam belong together, corners across it apart: a graph coloring of
    the sides. Each face goes with the side that is nearest along edges (Dijkstra). `points`
    (m, 3, 3) are the corners of the faces, in any frame.
    """
    corners = welding.corners
    seams = _seams(welding.positions, corners, charts.face_charts)
    if not len(seams.one):
        return charts
    color = _face_colors(points, corners, seams)
    parts = np.stack([corners, np.repeat(color[:, None], 3, axis=1)], axis=2)
    labels = connected_faces(row_ids(parts.reshape(-1, 2)).reshape(-1, 3))
    first = np.unique(labels, return_index=True)[1]
    old = charts.face_charts[first]
    return Charts(labels, charts.materials[old], charts.has_uv[old])


@dataclass(frozen=True)
class _Seams:
    """Edges inside one chart whose UV jumps: the corners (s, 2) of their ends on either side."""

    one: Int64Array
    other: Int64Array


def _seams(position: Int64Array, corners: Int64Array, charts: IntArray) -> _Seams:
    """Pair the face sides that join the same two positions within one chart."""
    places = np.stack([position, np.roll(position, -1, axis=1)], axis=2).reshape(-1, 2)
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    swap = places[:, 0] > places[:, 1]
    places[swap], ends[swap] = places[swap, ::-1], ends[swap, ::-1]
    chart = np.repeat(charts, 3)
    order = np.lexsort((places[:, 1], places[:, 0], chart))
    keys = np.column_stack([chart, places])[order]
    paired = (keys[1:] == keys[:-1]).all(axis=1)
    one, other = ends[order[:-1][paired]], ends[order[1:][paired]]
    jumps = (one != other).any(axis=1)
    return _Seams(one[jumps], other[jumps])


def _face_colors(points: Float64Array, corners: Int64Array, seams: _Seams) -> Int64Array:
    """The color (m,) of the nearest seam side; 0 on charts that do not meet themselves."""
    sources, color = _side_colors(seams)
    distance, nearest = _nearest(points, corners, sources)
    of_corner = np.zeros(len(distance), dtype=np.int64)
    of_corner[sources] = color
    reached = nearest >= 0
    of_corner[reached] = of_corner[nearest[reached]]
    closest = corners[np.arange(len(corners)), distance[corners].argmin(axis=1)]
    return of_corner[closest]


def _side_colors(seams: _Seams) -> tuple[Int64Array, Int64Array]:
    """The corners on seams, and colors that differ across every seam edge.

    The tip of a seam is the same corner on both sides: it belongs to neither.
    """
    open_ends = seams.one != seams.other
    across = np.stack([seams.one[open_ends], seams.other[open_ends]], axis=1)
    whole = open_ends.all(axis=1)
    along = np.concatenate([seams.one[whole], seams.other[whole]])
    sources, flat = np.unique(np.concatenate([across, along]), return_inverse=True)
    pairs = flat.reshape(-1, 2)
    joined = pairs[len(across) :]
    size = (len(sources), len(sources))
    graph = coo_matrix((np.ones(len(joined), dtype=bool), joined.T), shape=size)
    count, side = connected_components(graph, directed=False)
    apart: list[set[int]] = [set() for _ in range(count)]
    for first, second in side[pairs[: len(across)]].tolist():
        if first != second:
            apart[first].add(second)
            apart[second].add(first)
    color = np.asarray(colored(apart, [0] * count)[0], dtype=np.int64)
    return sources, color[side]


def _nearest(
    points: Float64Array, corners: Int64Array, sources: Int64Array
) -> tuple[Float64Array, Int64Array]:
    """Of every corner the distance along edges to the nearest source, and which (-1: none)."""
    ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    lengths = np.linalg.norm(points - np.roll(points, -1, axis=1), axis=2).reshape(-1)
    unique, first = np.unique(np.sort(ends, axis=1), axis=0, return_index=True)
    size = int(corners.max()) + 1
    graph = coo_matrix((lengths[first], unique.T), shape=(size, size)).tocsr()
    distance, _, nearest = dijkstra(
        graph, directed=False, indices=sources, min_only=True, return_predecessors=True
    )
    return distance, nearest
