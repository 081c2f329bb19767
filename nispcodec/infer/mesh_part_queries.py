"""All mesh parts asked as a field is: on a chart that is given, too, not the nearest alone."""

from __future__ import annotations

import numpy as np

from nispcodec.core.arrays import Float32Array, Int32Array, IntArray
from nispcodec.core.mesh_part import MeshPart
from nispcodec.infer.mesh_queries import PlacedMeshes
from nispcodec.infer.mesh_search import MeshSearch
from nispcodec.infer.triangles import closest_weights, triangle_rows


class MeshPartQueries:
    """Every copy of every mesh part, to be asked at points (n, 3) float32, normalized frame."""

    def __init__(self, parts: tuple[MeshPart, ...]) -> None:
        self._meshes = PlacedMeshes(parts)

    @property
    def chart_count(self) -> int:
        """How many charts there are, those of every copy numbered through."""
        return len(self._meshes.chart_materials)

    def sdf(self, points: Float32Array) -> Float32Array:
        """Signed distance to the surface (n,); sheets have no inside."""
        return self._meshes.sdf(points)

    def normals(self, points: Float32Array) -> Float32Array:
        """Unit gradient of the distance (n, 3); on the surface the face's normal."""
        return self._meshes.normals(points)

    def charts(self, points: Float32Array, seen: bool = False) -> Int32Array:
        """The chart of the closest triangle (n,): a mesh has no openings to leave out."""
        return self._meshes.charts(points)

    def uv(self, points: Float32Array, charts: IntArray) -> Float32Array:
        """The asset's UV (n, 2) at the closest point on charts (n,); (0, 0) on one without."""
        triangles = self._meshes.triangles
        faces = self._meshes.closest(points).face
        elsewhere = np.flatnonzero(triangles.charts[faces] != charts)
        for chart in np.unique(charts[elsewhere]):
            rows = elsewhere[charts[elsewhere] == chart]
            own = np.flatnonzero(triangles.charts == chart)
            search = MeshSearch(triangles.corners[own], triangles.sheet[own])
            faces[rows] = own[search.closest(points[rows])[0]]
        corners = triangle_rows(triangles.corners[faces])
        weights = closest_weights(corners, points.T.astype(np.float64)).T
        uvs: Float32Array = np.einsum("nk,nkd->nd", weights, triangles.uvs[faces]).astype(
            np.float32
        )
        return uvs

    def project(self, points: Float32Array) -> Float32Array:
        """The closest points (n, 3)."""
        return self._meshes.closest(points).point.astype(np.float32)
