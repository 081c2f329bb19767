"""Mesh parts as something to ask: distance, closest point, normal, chart, UV at any point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import (
    BoolArray,
    Float32Array,
    Float64Array,
    FloatArray,
    IndexArray,
    Int32Array,
    IntArray,
)
from nispcodec.core.mesh_part import MeshPart
from nispcodec.infer.mesh_search import MeshSearch, SearchConfig
from nispcodec.infer.placements import PlacedTriangles
from nispcodec.infer.surface_normals import SurfaceNormals
from nispcodec.infer.triangles import closest_weights, triangle_rows

ON_SURFACE = 1e-6
"""Nearer than this in the normalized frame, float32 does not tell which way a point is off."""


@dataclass(frozen=True)
class Closest:
    """The closest point of triangles to each of n points.

    distance     (n,) float64, not signed, normalized frame; infinite where there is no triangle
    face         (n,) int32: the triangle, of those equally near that of the lowest number
    barycentric  (n, 3) float64: weights of its corners, from 0 to 1
    point        (n, 3) float64
    """

    distance: Float64Array
    face: Int32Array
    barycentric: Float64Array
    point: Float64Array


class PlacedMeshes:
    """All copies of all mesh parts of a document, in the normalized frame; see PlacedTriangles.

    Points (n, 3), any n, are float32 or float64, finite, in the normalized frame. Work is done in
    blocks on every core, so memory is bounded beyond input and output. Without any triangle
    distances are infinite and all else is 0. Raises FormatError for more copies of triangles than
    can be held, or copies a million radii away.
    """

    def __init__(self, parts: tuple[MeshPart, ...], config: SearchConfig = SearchConfig()) -> None:
        self.triangles = PlacedTriangles.of(parts)
        self._config = config
        self._charts: dict[int, tuple[IndexArray, MeshSearch]] = {}
        self._search = MeshSearch(self.triangles.corners, self.triangles.sheet, config)
        self._normals = SurfaceNormals(self.triangles.corners)

    @property
    def chart_count(self) -> int:
        """How many charts there are, those of every copy."""
        return len(self.triangles.chart_materials)

    @property
    def chart_materials(self) -> Int32Array:
        """(k,) int32: the material of each chart, those of the first part's first copy first."""
        return self.triangles.chart_materials

    @property
    def chart_has_uv(self) -> BoolArray:
        """(k,) bool: whether a chart has texture coordinates."""
        return self.triangles.chart_has_uv

    def closest(self, points: FloatArray, charts: IntArray | None = None) -> Closest:
        """The closest point to each; with charts (n,) the closest on the chart of each.

        Where a chart has no triangle the distance is infinite, and all else as without charts.
        """
        faces, squared = self._search.closest(points)
        if charts is not None:
            self._move_to_charts(points, charts, faces, squared)
        if not len(self.triangles.corners):
            nowhere = np.zeros((len(points), 3))
            return Closest(np.sqrt(squared), faces, nowhere, nowhere.copy())
        corners = self.triangles.corners[faces]
        weights = closest_weights(triangle_rows(corners), points.T.astype(np.float64)).T
        return Closest(np.sqrt(squared), faces, weights, _mixed(weights, corners))

    def _move_to_charts(
        self, points: FloatArray, charts: IntArray, faces: Int32Array, squared: Float64Array
    ) -> None:
        """Change the faces (n,) and squared distances (n,) of points whose chart is another."""
        own = self.triangles.charts[faces] if len(self.triangles.charts) else charts
        elsewhere = np.flatnonzero(own != charts)
        for chart in np.unique(charts[elsewhere]).tolist():
            rows = elsewhere[charts[elsewhere] == chart]
            members, search = self._chart(chart)
            found, squared[rows] = search.closest(points[rows])
            if len(members):
                faces[rows] = members[found]

    def _chart(self, chart: int) -> tuple[IndexArray, MeshSearch]:
        """The faces of a chart and a search of them alone, which is kept."""
        if chart not in self._charts:
            members = np.flatnonzero(self.triangles.charts == chart)
            corners, sheet = self.triangles.corners[members], self.triangles.sheet[members]
            self._charts[chart] = members, MeshSearch(corners, sheet, self._config)
        return self._charts[chart]

    def sdf(self, points: FloatArray) -> Float32Array:
        """(n,) distances, negative inside: where the winding number is over 1/2 or under -1/2.

        Sheets have no inside.
        """
        _, squared = self._search.closest(points)
        distances = np.sqrt(squared).astype(np.float32)
        inside = self._search.inside(points) & (distances > 0)
        np.negative(distances, out=distances, where=inside)
        return distances

    def normals(self, points: FloatArray) -> Float32Array:
        """(n, 3) unit gradient of the distance; on the surface its normal, outwards.

        On edges and at corners that is the mean of their faces'. It is 0 without a triangle, and
        on one without area.
        """
        found = self.closest(points)
        away = points - found.point
        units = away / np.maximum(found.distance, np.finfo(np.float64).tiny)[:, None]
        units[self._search.inside(points)] *= -1
        near = np.flatnonzero(found.distance < ON_SURFACE)
        if len(near):
            normals = self._normals.at(found.face[near], found.barycentric[near])
            units[near] = self._outwards(found.point[near], normals)
        return units.astype(np.float32)

    def _outwards(self, points: Float64Array, normals: Float64Array) -> Float64Array:
        """Normals (n, 3) at points on the surface, turned where inside is before them, not behind.

        So it does not matter which way the faces of a body look.
        """
        before, behind = (
            self._search.inside(points + side * ON_SURFACE * normals) for side in (1, -1)
        )
        return np.where((before & ~behind)[:, None], -normals, normals)

    def charts(self, points: FloatArray, seen: bool = False) -> Int32Array:
        """(n,) int32: the chart of the closest triangle. A mesh has none but `seen` ones."""
        if not len(self.triangles.charts):
            return np.zeros(len(points), np.int32)
        return self.triangles.charts[self._search.closest(points)[0]]

    def uv(self, points: FloatArray, charts: IntArray | None = None) -> Float32Array:
        """(n, 2) float32: the asset's UV at the closest point; with charts (n,) on these.

        (0, 0) on a chart without UV.
        """
        found = self.closest(points, charts)
        if not len(self.triangles.uvs):
            return np.zeros((len(points), 2), np.float32)
        return _mixed(found.barycentric, self.triangles.uvs[found.face]).astype(np.float32)

    def project(self, points: FloatArray) -> Float32Array:
        """(n, 3) float32: the closest points."""
        return self.closest(points).point.astype(np.float32)


def _mixed(weights: Float64Array, corners: Float64Array) -> Float64Array:
    """(n, d): values at corners (n, 3, d) by weights (n, 3)."""
    mixed: Float64Array = (weights[:, :, None] * corners).sum(axis=1)
    return mixed
