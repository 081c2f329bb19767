"""Charts: patches of faces connected through shared (material, position, uv) corners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from nispcodec.asset import FloatArray, IndexArray, TexturedMesh

Kind = TypeVar("Kind")


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
    uv = uv_ids(mesh)
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
    neighbours apart: some hundred charts become a dozen labels. points (n, 3) cover the visible
    surface.
    """
    kinds = list(zip(charts.materials.tolist(), charts.has_uv.tolist(), strict=True))
    labels, kind = colored(_neighbours(len(charts), points, point_charts, gap), kinds)
    return Charts(
        np.asarray(labels, dtype=np.int32)[charts.face_charts],
        np.asarray([material for material, _ in kind], dtype=np.int32),
        np.asarray([has_uv for _, has_uv in kind], dtype=bool),
    )


def colored(neighbours: list[set[int]], kinds: list[Kind]) -> tuple[list[int], list[Kind]]:
    """Colour a graph so that neighbours differ and every colour is of one kind.

    Returns each node's colour and each colour's kind. Most constrained node first (Welsh and
    Powell 1967).
    """
    color = [-1] * len(neighbours)
    kind_of_color: list[Kind] = []
    for node in sorted(range(len(neighbours)), key=lambda n: -len(neighbours[n])):
        taken = {color[other] for other in neighbours[node]}
        alike = (c for c, k in enumerate(kind_of_color) if k == kinds[node] and c not in taken)
        color[node] = next(alike, len(kind_of_color))
        if color[node] == len(kind_of_color):
            kind_of_color.append(kinds[node])
    return color, kind_of_color


def _neighbours(
    count: int, points: FloatArray, charts: NDArray[np.integer], gap: float
) -> list[set[int]]:
    """For each of `count` charts, the others that come closer than `gap`.

    Told by cells of that size and their neighbours, so that memory is bounded by the points: some
    charts up to a few times as far apart count as well.
    """
    cells, cell = np.unique(np.floor(points / gap), axis=0, return_inverse=True)
    shape = (len(cells), count)
    there = coo_matrix((np.ones(len(cell), dtype=bool), (cell.reshape(-1), charts)), shape=shape)
    adjacent = (there.T @ (_near_cells(cells) @ there)).tocoo()
    neighbours: list[set[int]] = [set() for _ in range(count)]
    for one, other in zip(adjacent.row.tolist(), adjacent.col.tolist(), strict=True):
        if one != other:
            neighbours[one].add(other)
    return neighbours


def _near_cells(cells: FloatArray) -> coo_matrix:
    """(c, c) bool: cells (c, 3) of integers that touch, themselves included."""
    pairs = cKDTree(cells).query_pairs(1.0, p=np.inf, output_type="ndarray")
    own = np.arange(len(cells))
    rows = np.concatenate([pairs[:, 0], pairs[:, 1], own])
    columns = np.concatenate([pairs[:, 1], pairs[:, 0], own])
    size = (len(cells), len(cells))
    return coo_matrix((np.ones(len(rows), dtype=bool), (rows, columns)), shape=size).tocsr()


def row_ids(rows: NDArray[np.number[Any]]) -> NDArray[np.int64]:
    """(n, c) -> (n,): equal rows get equal numbers."""
    if not len(rows):
        return np.zeros(0, dtype=np.int64)
    # Adding zero makes -0.0 the same as 0.0, which np.unique tells apart.
    return np.unique(rows + rows.dtype.type(0), axis=0, return_inverse=True)[1].reshape(-1)


def uv_ids(mesh: TexturedMesh) -> NDArray[np.int64]:
    """(m, 3): equal UVs get equal numbers; -1 on faces without UV."""
    if not len(mesh.uvs):
        return np.full(mesh.faces.shape, -1, dtype=np.int64)
    return np.where(mesh.has_uv[:, None], row_ids(mesh.uvs)[mesh.uv_faces], -1)


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
