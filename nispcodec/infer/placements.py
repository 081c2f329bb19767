"""Every copy of every mesh part as one list of triangles in the normalized frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Float64Array, Int32Array
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import PART, MeshPart, Placement, check_placed_faces
from nispcodec.core.placing import placed_points

FAR = 1e6
"""In radii of the asset: squares of squares of coordinates are far from what float64 holds."""


@dataclass(frozen=True)
class PlacedTriangles:
    """Triangles of all copies: part after part, in a part placement after placement.

    corners (f, 3, 3) float64, normalized frame; uvs (f, 3, 2) float64, the asset's, 0 without UV
    charts  (f,) int32 into chart_materials (k,) int32 and chart_has_uv (k,) bool, which are
            numbered likewise: each copy has charts of its own
    sheet   (f,) bool: faces of open sheets, which have no inside

    The second and third corner of a mirrored copy's triangles have changed places, so that its
    faces look outwards where the part's do.
    """

    corners: Float64Array
    uvs: Float64Array
    charts: Int32Array
    sheet: BoolArray
    chart_materials: Int32Array
    chart_has_uv: BoolArray

    @staticmethod
    def of(parts: tuple[MeshPart, ...]) -> PlacedTriangles:
        """The copies of parts, which may be none.

        Raises FormatError where there are more than MAX_PLACED_FACES, or one leaves the cube of
        FAR radii: small files can claim large scenes.
        """
        check_placed_faces(sum(part.placed_faces for part in parts))
        copies = [_placed(part, each) for part in parts for each in part.placements]
        if not copies:
            return _none()
        starts = np.cumsum([0, *(len(copy.chart_materials) for copy in copies)])
        charts = [copy.charts + start for copy, start in zip(copies, starts, strict=False)]
        corners = np.concatenate([copy.corners for copy in copies])
        _check_place(corners)
        return PlacedTriangles(
            corners=corners,
            uvs=np.concatenate([copy.uvs for copy in copies]),
            charts=np.concatenate(charts).astype(np.int32),
            sheet=np.concatenate([copy.sheet for copy in copies]),
            chart_materials=np.concatenate([copy.chart_materials for copy in copies]),
            chart_has_uv=np.concatenate([copy.chart_has_uv for copy in copies]),
        )


def _check_place(corners: Float64Array) -> None:
    far = np.abs(corners).max(initial=0)
    if not far <= FAR:
        raise FormatError(PART, "placements", f"coordinates up to {FAR:g}", float(far))


def _none() -> PlacedTriangles:
    whole, yes = np.zeros(0, np.int32), np.zeros(0, np.bool_)
    return PlacedTriangles(np.zeros((0, 3, 3)), np.zeros((0, 3, 2)), whole, yes, whole, yes)


def _placed(part: MeshPart, placement: Placement) -> PlacedTriangles:
    """One copy, its charts numbered from 0."""
    order = [0, 2, 1] if placement.mirrored else [0, 1, 2]
    corners = placed_points(placement, part.normalized())[part.faces[:, order]]
    materials = part.chart_materials if placement.materials is None else placement.materials
    return PlacedTriangles(
        corners=corners,
        uvs=_uvs(part, placement)[:, order],
        charts=part.face_charts,
        sheet=part.sheet,
        chart_materials=materials,
        chart_has_uv=part.chart_has_uv,
    )


def _uvs(part: MeshPart, placement: Placement) -> Float64Array:
    """(m, 3, 2): the asset's UV at each corner; 0 on charts without."""
    uvs = np.zeros((len(part.faces), 3, 2))
    dressed = part.chart_has_uv[part.face_charts]
    uvs[dressed] = part.asset_uvs()[part.uv_faces[dressed]]
    uvs[dressed] = uvs[dressed] * np.asarray(placement.uv_scale) + np.asarray(placement.uv_offset)
    return uvs
