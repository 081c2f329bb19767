"""Charts: patches of faces connected through shared (material, position, uv) corners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from nispcodec.asset import FloatArray, IndexArray, TexturedMesh


@dataclass(frozen=True)
class Charts:
    """The charts of one mesh: face_charts (m,) int32 in 0 ... k-1; materials (k,); has_uv (k,)."""

    face_charts: IndexArray
    materials: IndexArray
    has_uv: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.materials)


def split_charts(mesh: TexturedMesh) -> Charts:
    """Label every face with its chart; the faces of one material without UV make one chart.

    Positions and UVs are compared by value, so that vertices which a file format had to split
    (glTF) still connect. Charts are numbered by their first face.
    """
    position = row_ids(mesh.positions)[mesh.faces]
    uv = np.where(mesh.has_uv[:, None], _uv_ids(mesh), -1)
    position = np.where(uv < 0, -1, position)
    material = np.repeat(mesh.face_materials[:, None], 3, axis=1)
    corners = row_ids(np.stack([material, position, uv], axis=-1).reshape(-1, 3))
    labels = connected_faces(corners.reshape(-1, 3))
    first = np.unique(labels, return_index=True)[1]
    return Charts(labels, mesh.face_materials[first], mesh.has_uv[first])


def merge_distant(
    charts: Charts, points: FloatArray, point_charts: NDArray[np.integer], gap: float
) -> Charts:
    """Let charts of one material that are everywhere further apart than `gap` share a number.

    A position tells such charts apart already, so the networks need a number only to keep
    neighbours apart: some hundred charts become a dozen labels. Graph colouring, most
    constrained chart first (Welsh and Powell 1967). points (n, 3) cover the visible surface.
    """
    neighbours = _neighbours(len(charts), points, point_charts, gap)
    kinds = np.stack([charts.materials, charts.has_uv], axis=1)
    label = np.full(len(charts), -1, dtype=np.int32)
    kind_of_label: list[tuple[int, int]] = []
    for chart in sorted(range(len(charts)), key=lambda c: -len(neighbours[c])):
        kind = (int(kinds[chart, 0]), int(kinds[chart, 1]))
        taken = {int(label[other]) for other in neighbours[chart]}
        free = [i for i, k in enumerate(kind_of_label) if k == kind and i not in taken]
        if not free:
            free = [len(kind_of_label)]
            kind_of_label.append(kind)
        label[chart] = free[0]
    table = np.asarray(kind_of_label, dtype=np.int32)
    return Charts(label[charts.face_charts], table[:, 0], table[:, 1].astype(bool))


def _neighbours(
    count: int, points: FloatArray, charts: NDArray[np.integer], gap: float
) -> list[set[int]]:
    """For each of `count` charts, the others that come closer than `gap`."""
    pairs = cKDTree(points).query_pairs(gap, output_type="ndarray")
    touching = np.unique(np.sort(charts[pairs], axis=1), axis=0)
    neighbours: list[set[int]] = [set() for _ in range(count)]
    for one, other in touching.tolist():
        if one != other:
            neighbours[one].add(other)
            neighbours[other].add(one)
    return neighbours


def row_ids(rows: NDArray[np.number[Any]]) -> NDArray[np.int64]:
    """(n, c) -> (n,): equal rows get equal numbers."""
    if not len(rows):
        return np.zeros(0, dtype=np.int64)
    # Adding zero makes -0.0 the same as 0.0, which np.unique tells apart.
    return np.unique(rows + rows.dtype.type(0), axis=0, return_inverse=True)[1].reshape(-1)


def _uv_ids(mesh: TexturedMesh) -> NDArray[np.int64]:
    if not len(mesh.uvs):
        return np.full(mesh.faces.shape, -1, dtype=np.int64)
    return row_ids(mesh.uvs)[mesh.uv_faces]


def connected_faces(corners: NDArray[np.int64]) -> IndexArray:
    faces = len(corners)
    rows = np.repeat(np.arange(faces), 3)
    columns = faces + corners.reshape(-1)
    size = faces + int(corners.max()) + 1
    graph = coo_matrix((np.ones(3 * faces, dtype=bool), (rows, columns)), shape=(size, size))
    labels = connected_components(graph, directed=False)[1][:faces]
    return _numbered_by_first(labels)


def _numbered_by_first(labels: NDArray[np.integer]) -> IndexArray:
    _, first, inverse = np.unique(labels, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int32)
    rank[np.argsort(first)] = np.arange(len(first), dtype=np.int32)
    numbered: IndexArray = rank[inverse.reshape(-1)]
    return numbered
