"""From a document to a textured mesh: the decoder's recipe, one line a stage."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document
from nispcodec.core.network import Network
from nispcodec.extract.components import (
    SPECK_AREA,
    ExtractionReport,
    components,
    without,
    without_noise,
)
from nispcodec.extract.grid import LIMIT
from nispcodec.extract.isosurface import Surface, extract, near_surface
from nispcodec.extract.seams import cut_along_seams
from nispcodec.extract.simplify import deviation, simplest, simplified
from nispcodec.extract.thin_walls import thin_share
from nispcodec.extract.vertex_charts import vertex_charts
from nispcodec.infer.texture_coordinates import asset_uv

LEAST, MOST = 256, 512
# Where this share of the surface has walls thinner than a cell, up to FACES triangles are spent.
THIN = 0.02
FACES = 500_000
FACES_A_BLOCK = 6.6
MAX_RESOLUTION = 2048
FITTINGS = 4


def textured_mesh(
    document: Document,
    resolution: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    keep_spurious: bool = False,
) -> tuple[TexturedMesh, ExtractionReport]:
    """The document's surface in the world frame, textured, and a report on its extraction.

    The mesh's warnings tell what was dropped.
    resolution: cells along the cube's edge, see `default_resolution`; faces: the most triangles
    that the mesh may have, seams included; error: as few triangles as keep the mean distance to the
    field's surface below it (normalized frame); keep_spurious: do not drop noise of the field.
    """
    surface, report = _surface(document, resolution, error, keep_spurious)
    if error is not None:
        surface = simplest(document.sdf, surface, error)
    cut, charts = _cut(document, surface) if faces is None else _fitted(document, surface, faces)
    mesh = _dressed(document, *_opened(document, cut, charts))
    return replace(mesh, warnings=report.warnings), report


def default_resolution(network: Network, half_thickness: float) -> int:
    """256; for thin walls up to 512, as triangles allow; one cell for sheets' half thickness."""
    points, size = near_surface(network, LEAST)
    thin = thin_share(network, points, size, 2 * LIMIT / LEAST)
    affordable = int(LEAST * np.sqrt(FACES / (FACES_A_BLOCK * max(len(points), 1))))
    cells = min(max(LEAST, affordable), MOST) if thin > THIN else LEAST
    sheets = int(np.ceil(2 * LIMIT / half_thickness)) if half_thickness else 0
    return min(max(cells, sheets), MAX_RESOLUTION)


def _surface(
    document: Document, resolution: int | None, error: float | None, keep_spurious: bool
) -> tuple[Surface, ExtractionReport]:
    """The surface at the resolution asked for, or at one that is fine enough for `error`."""
    cells = resolution or default_resolution(document.sdf, document.half_thickness)
    while True:
        surface, report = without_noise(document.sdf, extract(document.sdf, cells), keep_spurious)
        given = resolution is not None or error is None or 2 * cells > MAX_RESOLUTION
        if given or deviation(document.sdf, surface) <= (error or 0.0):
            return surface, report
        cells *= 2


def _cut(document: Document, surface: Surface) -> tuple[Surface, Int32Array]:
    """The surface with one chart a face, and those charts (m,)."""
    if document.chart is None:
        return surface, np.zeros(len(surface.faces), np.int32)
    charts = vertex_charts(document.chart, surface)
    return cut_along_seams(document.sdf, document.chart, surface, charts)


def _fitted(document: Document, surface: Surface, faces: int) -> tuple[Surface, Int32Array]:
    """The surface simplified until it has at most `faces` triangles after being cut."""
    target = faces
    for _ in range(FITTINGS):
        cut, charts = _cut(document, simplified(surface, target))
        if len(cut.faces) <= faces:
            break
        target = int(0.99 * target * faces / len(cut.faces))
    return cut, charts


def _opened(document: Document, surface: Surface, charts: Int32Array) -> tuple[Surface, Int32Array]:
    """Without the membranes that the field draws across the asset's openings.

    Islands in them, tiny pieces of another chart, go as well: the chart network was wrong there.
    """
    if not document.charts.openings:
        return surface, charts
    kept = charts != len(document.charts) - 1
    used, corners = np.unique(surface.faces[kept], return_inverse=True)
    faces = corners.reshape(-1, 3).astype(np.int32)
    opened = Surface(surface.positions[used], faces, surface.cell)
    count, labels = components(opened)
    rim = labels[np.isin(used, surface.faces[~kept])]
    tiny = np.bincount(labels, minlength=count) * surface.cell**2 < SPECK_AREA
    islands = tiny & (np.bincount(rim, minlength=count) > 0)
    left = ~islands[labels[faces[:, 0]]]
    return without(opened, islands, labels), charts[kept][left]


def _dressed(document: Document, surface: Surface, charts: Int32Array) -> TexturedMesh:
    """The surface with UVs, doubled at seams: one UV for each vertex and chart that meet."""
    table = document.charts
    corners = np.repeat(charts[:, None], 3, axis=1)
    keys = surface.faces.astype(np.int64) << 32 | corners
    pairs, inverse = np.unique(keys[table.has_uv[charts]], return_inverse=True)
    uvs = asset_uv(document, surface.positions[pairs >> 32], (pairs & 0xFFFFFFFF).astype(np.int32))
    uv_faces = np.full(surface.faces.shape, -1, np.int32)
    uv_faces[table.has_uv[charts]] = inverse.reshape(-1, 3)
    return TexturedMesh(
        positions=document.frame.to_world(surface.positions),
        faces=surface.faces,
        uvs=uvs.astype(np.float64),
        uv_faces=uv_faces,
        face_materials=table.materials[charts].astype(np.int32),
        materials=document.materials,
        textures=document.textures,
        name=str(document.info.get("name", "mesh")),
    )
