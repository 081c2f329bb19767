"""Mesh parts as a textured mesh: every copy in its place, its faces and seams as they are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array
from nispcodec.core.asset import TexturedMesh
from nispcodec.core.creases import turned_sides
from nispcodec.core.document import Document
from nispcodec.core.mesh_part import MeshPart, Placement
from nispcodec.core.placing import placed_points
from nispcodec.extract.meeting import met


def joined(document: Document, field: TexturedMesh | None) -> TexturedMesh:
    """The surface of a document's field, if it has one, and its mesh parts; world frame."""
    pieces = list(_placed(document))
    parts = as_one(document, pieces) if pieces else None
    if parts and len(pieces) > 1:
        parts = met(parts, document.frame.radius, _silent(document))
    return as_one(document, [each for each in (field, parts) if each])


def as_one(document: Document, pieces: Sequence[TexturedMesh]) -> TexturedMesh:
    """Pieces of a document's surface, world frame, in one mesh of its materials and textures."""
    positions = _shifts([len(each.positions) for each in pieces])
    uvs = _shifts([len(each.uvs) for each in pieces])
    return TexturedMesh(
        positions=np.concatenate([each.positions for each in pieces]),
        faces=_concatenated(
            [each.faces + first for each, first in zip(pieces, positions, strict=True)]
        ),
        uvs=np.concatenate([each.uvs for each in pieces]),
        uv_faces=_concatenated(
            [
                np.where(each.uv_faces < 0, -1, each.uv_faces + first)
                for each, first in zip(pieces, uvs, strict=True)
            ]
        ),
        face_materials=_concatenated([each.face_materials for each in pieces]),
        materials=document.materials,
        textures=document.textures,
        name=str(document.info.get("name", "mesh")),
        creases=_creases(pieces) if document.meshes else None,
    )


def face_charts(document: Document) -> Int32Array:
    """(m,) int32: the chart of each face of `joined` without a field, numbered through."""
    first = len(document.field.charts) if document.field else 0
    charts = []
    for part in document.meshes:
        for _ in part.placements:
            charts.append(first + part.face_charts)
            first += len(part.chart_materials)
    return _concatenated(charts)


def _placed(document: Document) -> Iterator[TexturedMesh]:
    for part in document.meshes:
        for placement in part.placements:
            yield _copy(document, part, placement)


def _silent(document: Document) -> BoolArray:
    """(m,) bool: the faces of parts that say of no edge that it is a crease."""
    said = [(part.placed_faces, not part.creases.any()) for part in document.meshes]
    return np.repeat([silent for _, silent in said], [faces for faces, _ in said])


def _copy(document: Document, part: MeshPart, placement: Placement) -> TexturedMesh:
    materials = part.chart_materials if placement.materials is None else placement.materials
    turned = placement.mirrored
    return TexturedMesh(
        positions=document.frame.to_world(placed_points(placement, part.normalized())),
        faces=_winding(part.faces, turned),
        uvs=part.asset_uvs() * placement.uv_scale + placement.uv_offset,
        uv_faces=_winding(part.uv_faces, turned),
        face_materials=materials[part.face_charts].astype(np.int32),
        materials=document.materials,
        textures=document.textures,
        creases=turned_sides(part.shading_breaks) if turned else part.shading_breaks,
    )


def _creases(pieces: Sequence[TexturedMesh]) -> BoolArray:
    """Those of mesh parts; a field has none."""
    return np.concatenate(
        [
            np.zeros(each.faces.shape, np.bool_) if each.creases is None else each.creases
            for each in pieces
        ]
    )


def _winding(faces: Int32Array, turned: bool) -> Int32Array:
    """A reflection turns the faces inside out: they are wound the other way again."""
    return faces[:, [0, 2, 1]] if turned else faces


def _shifts(lengths: Sequence[int]) -> list[int]:
    return [0, *np.cumsum(lengths)[:-1].tolist()]


def _concatenated(arrays: Sequence[Int32Array]) -> Int32Array:
    return np.concatenate(arrays).astype(np.int32)
