"""From a document to a textured mesh: the decoder's recipe, one line a stage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from nispcodec.core.arrays import Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.document import Document, Field
from nispcodec.core.network import Network
from nispcodec.extract.border_edges import with_borders_told
from nispcodec.extract.coarser_parts import coarser
from nispcodec.extract.components import (
    ExtractionReport,
    components,
    without,
    without_noise,
)
from nispcodec.extract.config import (
    ExtractConfig,
    LevelConfig,
    ResolutionConfig,
    SimplifyConfig,
)
from nispcodec.extract.grid import CUBE
from nispcodec.extract.isosurface import Surface, extract, near_surface
from nispcodec.extract.mesh_parts import as_one, joined
from nispcodec.extract.seams import cut_along_seams
from nispcodec.extract.simplify import deviation, simplest, simplified
from nispcodec.extract.slivers import without_slivers
from nispcodec.extract.thin_walls import thin_share
from nispcodec.extract.vertex_charts import vertex_charts
from nispcodec.infer.field import FieldQueries


def textured_mesh(
    document: Document,
    resolution: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    keep_spurious: bool = False,
    config: ExtractConfig = ExtractConfig(),
) -> tuple[TexturedMesh, ExtractionReport]:
    """The document's surface in the world frame, textured, and a report on its extraction.

    The mesh's warnings tell what was dropped.
    resolution: cells along the cube's edge, see `default_resolution`; faces: the most triangles
    that the mesh may have, seams included, though mesh parts keep all of theirs; error: as few
    triangles as keep the mean distance to the field's surface below it (normalized frame), by
    default `negligible_error`, in at most `SimplifyConfig.most` triangles. Where only a resolution
    is given, all triangles of that grid are kept. keep_spurious: do not drop noise.
    """
    meshes, report = textured_levels(document, 1, resolution, faces, error, keep_spurious, config)
    return meshes[0], report


def textured_levels(
    document: Document,
    levels: int,
    resolution: int | None = None,
    faces: int | None = None,
    error: float | None = None,
    keep_spurious: bool = False,
    config: ExtractConfig = ExtractConfig(),
) -> tuple[list[TexturedMesh], ExtractionReport]:
    """The surface in `levels` of detail, from one extraction; the first is that of `textured_mesh`.

    Each has about `LevelConfig.share` of the triangles of the one before. Raises NispError where
    mesh parts are to be simplified without the packages for that.
    """
    parts = joined(document, None) if document.meshes else None
    whole = len(parts.faces) if parts else 0
    pieces = [_part_levels(document, parts, levels, config)] if parts else []
    report = ExtractionReport(0, 0, 0, 0)
    if document.field:
        most = None if faces is None else max(faces - whole, 1)
        found, report = _field_levels(
            document, document.field, levels, resolution, most, error, keep_spurious, config
        )
        pieces.insert(0, found)
    meshes = [as_one(document, level) for level in zip(*pieces, strict=True)]
    warnings = (*report.warnings, *_missed(len(meshes[0].faces), whole, faces))
    return [replace(mesh, warnings=warnings) for mesh in meshes], report


def negligible_error(
    info: Mapping[str, str | int | float | bool], config: SimplifyConfig = SimplifyConfig()
) -> float:
    """The mean distance, normalized frame, that nobody sees beside what the networks are off by.

    A part of the distance error that a file tells in its `info`, within limits; the usual one where
    it tells none.
    """
    told = info.get("distance_error")
    if isinstance(told, bool) or not isinstance(told, int | float) or not told > 0:
        return config.usual
    return min(max(config.share * told, config.finest), config.coarsest)


def default_resolution(
    network: Network,
    half_thickness: float,
    config: ResolutionConfig = ResolutionConfig(),
    most_faces: float = math.inf,
) -> int:
    """256; for thin walls up to 512, as triangles allow; one cell for sheets' half thickness.

    Fewer where that would give more than about `most_faces` triangles.
    """
    points, size = near_surface(network, config.least)
    some = points[:: max(1, len(points) // config.wall_samples)]
    thin = thin_share(network, some, size, 2 * CUBE / config.least, config)
    blocks = config.faces / (config.faces_per_block * max(len(points), 1))
    affordable = min(max(config.least, int(config.least * np.sqrt(blocks))), config.most)
    cells = affordable if thin > config.thin_share else config.least
    sheets = int(np.ceil(2 * CUBE / half_thickness)) if half_thickness else 0
    cells = min(max(cells, sheets), config.highest)
    faces = _faces_of(len(points), cells, config)
    return round(cells * min(1.0, math.sqrt(most_faces / max(faces, 1))))


def expected_faces(
    network: Network, resolution: int, config: ResolutionConfig = ResolutionConfig()
) -> int:
    """About how many triangles a grid of so many cells along its edge gives."""
    points, _ = near_surface(network, config.least)
    return _faces_of(len(points), resolution, config)


def _faces_of(blocks: int, resolution: int, config: ResolutionConfig) -> int:
    """The same, by the blocks of the least resolution that are near the surface."""
    return int(blocks * config.faces_per_block * (resolution / config.least) ** 2)


def field_surface(
    field: Field,
    resolution: int | None,
    error: float | None,
    keep_spurious: bool,
    config: ExtractConfig,
) -> tuple[Surface, ExtractionReport]:
    """The surface at the resolution asked for, or at one that is fine enough for `error`.

    It is closed: it has the closing surfaces of openings.
    """
    sdf, limits = field.sdf, config.resolution
    cells = resolution or default_resolution(sdf, field.half_thickness, limits)
    while True:
        found = extract(sdf, cells, config.isosurface)
        surface, report = without_noise(sdf, found, keep_spurious, config.components)
        given = resolution is not None or error is None or 2 * cells > limits.highest
        if given or deviation(sdf, surface) <= (error or 0.0):
            return surface, report
        cells *= 2


def _field_levels(
    document: Document,
    field: Field,
    levels: int,
    resolution: int | None,
    faces: int | None,
    error: float | None,
    keep_spurious: bool,
    config: ExtractConfig,
) -> tuple[list[TexturedMesh], ExtractionReport]:
    """The field's surface in levels; see `textured_levels`."""
    grid, report = field_surface(field, resolution, error, keep_spurious, config)
    if resolution is None and faces is None and error is None:
        # What the grid itself is off by cannot be had back.
        own = deviation(field.sdf, grid, config.simplify.measured)
        error = max(negligible_error(document.info, config.simplify), own)
        faces = config.simplify.most
    surface = grid if error is None else simplest(field.sdf, grid, error, faces, config.simplify)
    if faces is None:
        found = [_cut(field, surface, surface is not grid, config)]
    else:
        found = [_with_at_most(field, grid, surface, faces, config)]
    for count in _counts(len(found[0][0].faces), levels, config.levels):
        fewer = _with_at_most(field, grid, surface, count, config)
        # Seams take triangles of their own: there is a least number of them.
        found.append(min(found[-1], fewer, key=lambda cut: len(cut[0].faces)))
    dressed = (_dressed(document, field, *_opened(field, *cut, config)) for cut in found)
    return list(dressed), report


def _part_levels(
    document: Document, parts: TexturedMesh, levels: int, config: ExtractConfig
) -> list[TexturedMesh]:
    """The mesh parts in levels, the first as they are."""
    counts = _counts(len(parts.faces), levels, config.levels)
    return [parts, *(coarser(parts, document.frame, counts, config.levels) if counts else ())]


def _counts(faces: int, levels: int, config: LevelConfig) -> list[int]:
    """How many faces each level after the first is to have."""
    return [max(round(faces * config.share**level), config.least) for level in range(1, levels)]


def _cut(
    field: Field, surface: Surface, simple: bool, config: ExtractConfig
) -> tuple[Surface, Int32Array]:
    """The surface with one chart a face, and those charts (m,); a simple one without slivers."""
    if field.chart is None:
        cut, charts = surface, np.zeros(len(surface.faces), np.int32)
    else:
        told = with_borders_told(field.sdf, field.chart, surface, config.seams)
        charts = vertex_charts(field.chart, told, config.seams)
        cut, charts = cut_along_seams(field.sdf, field.chart, told, charts, config.seams)
    return without_slivers(field.sdf, cut, charts, config.slivers) if simple else (cut, charts)


def _with_at_most(
    field: Field, grid: Surface, surface: Surface, faces: int, config: ExtractConfig
) -> tuple[Surface, Int32Array]:
    """The grid's surface, simplified to `surface` and on to at most `faces` after being cut.

    Where that cannot be had, the fewest that were found: coarser is no longer fewer then, as seams
    take most of the faces.
    """
    target, found = faces, []
    for _ in range(config.simplify.face_fittings):
        surface = simplified(field.sdf, surface, target, config.simplify)
        cut, charts = _cut(field, surface, surface is not grid, config)
        found.append((cut, charts))
        # Far from its target it is stuck: asked for less it takes as long, and gives the same.
        if len(cut.faces) <= faces or len(surface.faces) > config.simplify.stuck * target:
            break
        target = _left_to(len(surface.faces), len(cut.faces), faces)
    return min(found, key=lambda each: len(each[0].faces))


def _left_to(bare: int, cut: int, faces: int) -> int:
    """How many triangles are to be cut for `faces`, where `bare` ones became `cut`.

    What seams take goes with the length of a triangle's side: with the root of their number.
    """
    taken = max(cut - bare, 0) / math.sqrt(bare)
    return int(((math.sqrt(taken**2 + 4 * 0.98 * faces) - taken) / 2) ** 2)


def _missed(found: int, whole: int, faces: int | None) -> tuple[str, ...]:
    """A warning where there are more faces than asked for; `whole` of them are of mesh parts."""
    if faces is None or found <= faces:
        return ()
    why = f"{whole:,} are of triangles that the file holds, which are kept as they are"
    if not whole:
        why = "the surface has too many pieces and seams for fewer"
    return (f"expected at most {faces:,} faces, found {found:,}: {why}",)


def _opened(
    field: Field, surface: Surface, charts: Int32Array, config: ExtractConfig
) -> tuple[Surface, Int32Array]:
    """Without the closing surfaces that the field draws across the asset's openings.

    Islands in them, tiny pieces of another chart, go as well: the chart network was wrong there.
    """
    if not field.charts.openings:
        return surface, charts
    kept = charts != len(field.charts) - 1
    used, corners = np.unique(surface.faces[kept], return_inverse=True)
    faces = corners.reshape(-1, 3).astype(np.int32)
    opened = Surface(surface.positions[used], faces, surface.cell)
    count, labels = components(opened)
    rim = labels[np.isin(used, surface.faces[~kept])]
    areas = np.bincount(labels, minlength=count) * surface.cell**2
    tiny = areas < config.components.small_area
    islands = tiny & (np.bincount(rim, minlength=count) > 0)
    left = ~islands[labels[faces[:, 0]]]
    return without(opened, islands, labels), charts[kept][left]


def _dressed(
    document: Document, field: Field, surface: Surface, charts: Int32Array
) -> TexturedMesh:
    """The surface with UVs, doubled at seams: one UV for each vertex and chart that meet."""
    table = field.charts
    corners = np.repeat(charts[:, None], 3, axis=1)
    keys = surface.faces.astype(np.int64) << 32 | corners
    pairs, inverse = np.unique(keys[table.has_uv[charts]], return_inverse=True)
    own = (pairs & 0xFFFFFFFF).astype(np.int32)
    uvs = FieldQueries(field).uv(surface.positions[pairs >> 32], own)
    uv_faces = np.full(surface.faces.shape, -1, np.int32)
    uv_faces[table.has_uv[charts]] = inverse.reshape(-1, 3)
    return TexturedMesh(
        positions=document.frame.to_world(surface.positions),
        faces=surface.faces,
        # What is not finite counts as 0, as where a texture is asked.
        uvs=np.nan_to_num(uvs.astype(np.float64), posinf=0.0, neginf=0.0),
        uv_faces=uv_faces,
        face_materials=table.materials[charts].astype(np.int32),
        materials=document.materials,
        textures=document.textures,
        name=str(document.info.get("name", "mesh")),
    )
