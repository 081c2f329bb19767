"""One part: its numbers, then its surface, positions, edges, charts, UVs and placements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nispcodec.core.arrays import Int32Array, Int64Array
from nispcodec.core.connectivity import row_ids
from nispcodec.core.errors import FormatError
from nispcodec.core.mesh_part import MAX_GRID_BITS, MeshPart
from nispcodec.format.mesh import (
    charts,
    copies,
    edges,
    manifold,
    placements,
    positions,
    slots,
    texture,
)
from nispcodec.format.mesh.binary_coder import SECTION, BinaryCoder
from nispcodec.format.mesh.charts import Charts
from nispcodec.format.mesh.connectivity import Growth, Known, Surface
from nispcodec.format.mesh.fields import number, single
from nispcodec.format.mesh.positions import Vector
from nispcodec.format.mesh.surface import Given
from nispcodec.format.record import located

NONE = (0.0, 0.0, 0.0)


def code(coder: BinaryCoder, most: int, part: MeshPart | None) -> tuple[MeshPart, int]:
    """A part, as it is decoded, and what it leaves of `most`.

    The latter bounds faces, placements and their materials together. Raises FormatError.
    """
    count = number(coder, len(part.faces) if part else 0, most, "faces")
    if count == 0:
        raise FormatError(SECTION, "faces", "at least one", 0)
    grids = _code_grids(coder, part)
    surface, given = _surface(coder, count, part)
    corners, places = _places(coder, surface, grids.bits, given)
    twin = np.array(surface.twin, np.int64)
    sheet = charts.code_sheets(coder, twin, given)
    seams, creases = edges.code(coder, surface, corners, places, given)
    joined = np.where(seams, -1, twin)
    found = charts.code(coder, joined, given)
    at = [places[vertex] for vertex in corners]
    uvs, uv_faces = _uvs(coder, joined, found, at, grids.uv_bits, given)
    wanted = part.placements if part else None
    copied, left = placements.code(coder, found, most - count, wanted)
    with located(SECTION, ""):
        made = MeshPart(
            positions=np.array(places, np.int32),
            faces=np.array(corners, np.int32).reshape(-1, 3),
            uvs=uvs,
            uv_faces=uv_faces,
            face_charts=found.faces,
            chart_materials=found.materials,
            chart_has_uv=found.has_uv,
            creases=creases.reshape(-1, 3),
            sheet=sheet,
            step=grids.step,
            origin=grids.origin,
            uv_step=grids.uv_step,
            uv_origin=grids.uv_origin,
            placements=copied,
        )
    return made, left


@dataclass(frozen=True)
class _Grids:
    """Bits of coordinates, and the spacing and origin of both grids, as `MeshPart` has them."""

    bits: int
    uv_bits: int
    step: float
    origin: tuple[float, float, float]
    uv_step: tuple[float, float]
    uv_origin: tuple[float, float]


def _code_grids(coder: BinaryCoder, part: MeshPart | None) -> _Grids:
    bits = _grid_bits(coder, part.positions[part.faces] if part else None, "position_bits")
    uv_bits = _grid_bits(coder, _used_uvs(part) if part else None, "uv_bits")
    step = single(coder, part.step if part else 0.0, slots.STEP, "step")
    x, y, z = _singles(coder, part.origin if part else NONE, slots.ORIGIN, "origin")
    su, sv = _singles(coder, part.uv_step if part else NONE[:2], slots.UV_STEP, "uv_step")
    u, v = _singles(coder, part.uv_origin if part else NONE[:2], slots.UV_ORIGIN, "uv_origin")
    return _Grids(bits, uv_bits, step, (x, y, z), (su, sv), (u, v))


def _used_uvs(part: MeshPart) -> Int32Array:
    uvs: Int32Array = part.uvs[part.uv_faces[part.uv_faces >= 0]]
    return uvs


def _grid_bits(coder: BinaryCoder, values: Int32Array | None, name: str) -> int:
    highest = int(values.max()) if values is not None and values.size else 0
    bits = coder.bits(highest.bit_length(), 5)
    if bits > MAX_GRID_BITS:
        raise FormatError(SECTION, name, f"at most {MAX_GRID_BITS}", bits)
    return bits


def _singles(coder: BinaryCoder, given: tuple[float, ...], slot: int, name: str) -> list[float]:
    return [single(coder, value, slot, name) for value in given]


def _surface(coder: BinaryCoder, count: int, part: MeshPart | None) -> tuple[Surface, Given | None]:
    if part is None:
        return Growth(coder, None).grow(count), None
    twin = manifold.twins(part.faces, part.sheet, _unlike(part))
    known = Known(twin.tolist(), manifold.fans(twin).tolist(), [-1] * count)
    surface = Growth(coder, known).grow(count)
    return surface, Given(part, np.array(known.sides), np.array(surface.twin))


def _unlike(part: MeshPart) -> Callable[[int, int], int]:
    """How little two sides of one edge belong together: other UVs, another chart, the same face."""
    uvs = np.append(row_ids(part.uvs), -1)[part.uv_faces.reshape(-1)].tolist()
    charts = part.face_charts.tolist()
    sets = [set(face) for face in part.faces.tolist()]

    def unlike(one: int, other: int) -> int:
        after, beyond = one - one % 3 + (one + 1) % 3, other - other % 3 + (other + 1) % 3
        seam = (uvs[one] != uvs[beyond]) + (uvs[after] != uvs[other])
        face, over = one // 3, other // 3
        return seam + 2 * (charts[face] != charts[over]) + 8 * (sets[face] == sets[over])

    return unlike


def _places(
    coder: BinaryCoder, surface: Surface, bits: int, given: Given | None
) -> tuple[list[int], list[Vector]]:
    """The vertex of each corner of the file, and where each vertex lies."""
    points = wanted = None
    if given:
        table = dict(zip(surface.corners, given.vertices(), strict=True))
        points = [table[point] for point in range(surface.points)]
    vertices = copies.code(coder, surface.points, points)
    corners = [vertices[point] for point in surface.corners]
    count = max(vertices) + 1
    if given:
        originals = dict(zip(corners, given.vertices(), strict=True))
        rows = given.part.positions[[originals[vertex] for vertex in range(count)]]
        wanted = [(x, y, z) for x, y, z in rows.tolist()]
    for at in range(0, len(corners), 3):
        if len(set(corners[at : at + 3])) < 3:
            raise FormatError(SECTION, "faces", "three vertices each", corners[at : at + 3])
    return corners, positions.code(coder, corners, surface.twin, count, bits, wanted)


def _uvs(
    coder: BinaryCoder,
    joined: Int64Array,
    found: Charts,
    places: list[Vector],
    bits: int,
    given: Given | None,
) -> tuple[Int32Array, Int32Array]:
    """Coordinates (t, 2) of faces that have some, and which (m, 3) each corner has, or -1."""
    dressed = np.repeat(found.has_uv[found.faces], 3)
    corners = np.flatnonzero(dressed)
    uv_faces = np.full(len(joined), -1, np.int32)
    places_of = np.cumsum(dressed) - 1
    twin = np.where(joined[corners] >= 0, places_of[joined[corners]], -1)
    _, first, nodes = np.unique(
        manifold.fans(joined)[corners], return_index=True, return_inverse=True
    )
    wanted = [(u, v) for u, v in given.uvs()[corners[first]].tolist()] if given else None
    at = [places[corner] for corner in corners[first].tolist()]
    uvs = texture.code(coder, nodes.tolist(), twin.tolist(), at, bits, wanted)
    uv_faces[corners] = nodes
    return np.array(uvs, np.int32).reshape(-1, 2), uv_faces.reshape(-1, 3)
