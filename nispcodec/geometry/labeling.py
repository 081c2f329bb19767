"""The labels of points: distance, chart and UV at the closest point of the surface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nispcodec.core.arrays import Float32Array, Float64Array, Int64Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import ChartTable
from nispcodec.core.sample_set import SampleSet
from nispcodec.geometry.charts import Charts
from nispcodec.geometry.distance import Closest, DistanceField
from nispcodec.geometry.surface_points import barycentric


@dataclass(frozen=True)
class Labeling:
    """Labels points by the faces of one mesh, its charts and its chart table.

    field   the signed distance
    mesh    the asset, positions in the normalized frame
    charts  the chart of each face
    table   the charts as the file has them, and the map of the UVs
    """

    field: DistanceField
    mesh: TexturedMesh
    charts: Charts
    table: ChartTable

    def __call__(self, points: Float64Array, signed: bool = True) -> SampleSet:
        """The labels of points (n, 3), normalized frame (paper, eq. 2).

        Without `signed` all of space counts as outside, which saves most of the time.
        """
        return self.of(points, self.field.closest(points, signed))

    def of(self, points: Float64Array, closest: Closest) -> SampleSet:
        """The labels of points (n, 3) of which is known what is closest."""
        face = self.field.solid.parents[closest.piece]
        return SampleSet(
            points=points.astype(np.float32),
            sdf=closest.sdf.astype(np.float32),
            chart=self.charts.face_charts[face],
            uv=self._network_uv(closest, face),
        )

    def _network_uv(self, closest: Closest, face: Int64Array) -> Float32Array:
        weights = barycentric(self.mesh.positions[self.mesh.faces[face]], closest.point)
        uv = np.einsum("nc,ncx->nx", weights, self.mesh.uvs_at(face))
        scaled = (uv - np.asarray(self.table.uv_offset)) / np.asarray(self.table.uv_scale)
        has_uv = self.charts.has_uv[self.charts.face_charts[face]]
        return np.where(has_uv[:, None], scaled, 0.0).astype(np.float32)


def chart_table(mesh: TexturedMesh, charts: Charts, filled: float) -> ChartTable:
    """The chart table, with the affine map that brings the used UVs to [0, 1]^2.

    The map is the identity, which takes no bytes, where UVs lie within the unit square and fill at
    least the share `filled` of it in both directions.
    """
    used = mesh.corner_uvs[mesh.has_uv].reshape(-1, 2)
    if not len(used):
        return ChartTable(charts.materials, charts.has_uv)
    low, high = used.min(axis=0), used.max(axis=0)
    if low.min() >= 0 and high.max() <= 1 and (high - low).min() >= filled:
        return ChartTable(charts.materials, charts.has_uv)
    scale = np.where(high > low, high - low, 1.0)
    return ChartTable(
        charts.materials,
        charts.has_uv,
        uv_offset=(float(low[0]), float(low[1])),
        uv_scale=(float(scale[0]), float(scale[1])),
    )


def with_openings(table: ChartTable) -> ChartTable:
    """The table with one chart more, that of the openings."""
    return replace(
        table,
        materials=np.append(table.materials, np.int32(0)),
        has_uv=np.append(table.has_uv, False),
        openings=True,
    )
