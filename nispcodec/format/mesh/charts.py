"""All that holds for pieces of a surface: sheets, the charts' materials, whether they have UVs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import BoolArray, Int32Array, Int64Array
from nispcodec.core.connectivity import connected_components
from nispcodec.core.errors import FormatError
from nispcodec.format.mesh import slots
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.fields import member
from nispcodec.format.mesh.surface import Given

MATERIAL_BITS = 16


def pieces(twin: Int64Array) -> tuple[Int32Array, Int64Array]:
    """(3 m,) twins -> (m,) int32 the piece of each face, and the first face of each piece."""
    sides = np.flatnonzero(twin >= 0)
    piece = connected_components(sides // 3, twin[sides] // 3, len(twin) // 3)[1]
    return piece, np.unique(piece, return_index=True)[1]


def code_sheets(coder: BinaryCoder, twin: Int64Array, given: Given | None) -> BoolArray:
    """(m,): which faces are of sheets, the same for all faces that hang together by edges."""
    piece, first = pieces(twin)
    wanted = given.part.sheet[given.faces[first]].tolist() if given else [False] * len(first)
    found = [0]
    for sheet in wanted:
        found.append(coder.bit(sheet, slots.SHEET, found[-1], found[-1], found[-1]))
    return np.array(found[1:], np.bool_)[piece]


@dataclass(frozen=True)
class Charts:
    """Charts, numbered by their first faces in the file.

    faces      (m,) int32: the chart of each face
    has_uv     (k,) bool
    materials  (k,) int32
    bits       of a material
    given      (k,): of a part that is encoded, its own number of each chart
    """

    faces: Int32Array
    has_uv: BoolArray
    materials: Int32Array
    bits: int
    given: Int32Array | None


def code(coder: BinaryCoder, joined: Int64Array, given: Given | None) -> Charts:
    """The charts of a surface; `joined` are its twins but at seams. Raises FormatError."""
    faces, first = pieces(joined)
    charts = given.part.face_charts[given.faces[first]] if given else None
    wanted = [(True, 0)] * len(first)
    highest = 0
    if given:
        materials = given.part.chart_materials[charts].tolist()
        wanted = list(zip(given.part.chart_has_uv[charts].tolist(), materials, strict=True))
        highest = _highest(given)
    bits = coder.bits(highest.bit_length(), 5)
    if bits > MATERIAL_BITS:
        raise FormatError(SECTION, "material_bits", f"at most {MATERIAL_BITS}", bits)
    has_uv, material = [1], [0]
    for dressed, number in wanted:
        has_uv.append(coder.bit(dressed, slots.HAS_UV, has_uv[-1], has_uv[-1], has_uv[-1]))
        material.append(member(coder, number, bits, material[-1]))
    flags, numbers = np.array(has_uv[1:], np.bool_), np.array(material[1:], np.int32)
    return Charts(faces, flags, numbers, bits, charts)


def _highest(given: Given) -> int:
    """The highest material of charts and their copies.

    Raises FormatError for negative ones.
    """
    part = given.part
    tables = [part.chart_materials]
    tables += [each.materials for each in part.placements if each.materials is not None]
    materials = np.stack(tables)[:, np.unique(part.face_charts)]
    if materials.min() < 0:
        raise FormatError(SECTION, "materials", "0 or more", materials.min())
    return int(materials.max())
